# rows.awk: prints some rows and columns of a page's table, as a shorter page shows them.
#
#   awk -f rows.awk -v head='cell | trace(P) fixed' -v rows='kf, circle|ekf, circle' -v columns='1 2 3' PAGE
#
# The table is the first whose head begins with `head`. `rows` is an expression for what a row has between its first bar
# and a later one, and `columns` are numbers from 1 on, in the order in which they are printed.

function print_row(    i, cells) {
  split($0, cells, / *\| */)
  for (i = 1; i <= count; ++i) printf "| %s ", cells[wanted[i] + 1]
  print "|"
}

BEGIN { count = split(columns, wanted, " ") }
!/^\|/ && inside { exit }
!inside && index($0, "| " head) == 1 { inside = 1; print_row(); next }
inside && /^\|---/ { print_row(); next }
inside && $0 ~ ("^\\| (" rows ") \\|") { print_row() }
