# rows.awk: prints some rows and columns of a table, as a shorter page shows them.
#
#   awk -f rows.awk -v rows='kf, circle|ekf, circle' -v columns='1 2 3' TABLE.csv
#   awk -f rows.awk -v rows=... -v columns=... -v head='row | A' PAGE.md
#
# The table of a page is the first whose head begins with `head`. `rows` is an expression for what a row has between its
# first bar and a later one, and `columns` are numbers from 1 on, in the order in which they are printed.

# A line of a CSV file as a row of a Markdown table.
function with_bars(line,    i, c, quoted, row) {
  for (i = 1; i <= length(line); ++i) {
    c = substr(line, i, 1)
    if (c == "\"") quoted = !quoted
    else row = row (c == "," && !quoted ? " | " : c)
  }
  return "| " row " |"
}

function print_row(    i, cells) {
  split($0, cells, / *\| */)
  for (i = 1; i <= count; ++i) printf "| %s ", cells[wanted[i] + 1]
  print "|"
}

function print_line(    i) {
  for (i = 1; i <= count; ++i) printf "|---"
  print "|"
}

BEGIN { count = split(columns, wanted, " ") }
FILENAME ~ /\.csv$/ { $0 = with_bars($0) }
!/^\|/ && inside { exit }
!inside && index($0, "| " head) == 1 { inside = 1; print_row(); print_line(); next }
inside && $0 ~ ("^\\| (" rows ") \\|") { print_row() }
