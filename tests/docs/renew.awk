# renew.awk: prints a page of the documentation with every output as its command prints it now. check.sh calls it and says
# what a page looks like.
#
#   awk -v scratch=FOLDER -v slow=0|1 -v complaints=FILE -f renew.awk PAGE
#
# Commands run in FOLDER; complaints, a line each, are appended to FILE.

function complain(where, what) { printf "%s:%d: %s\n", FILENAME, where, what >>complaints }

# The lines that the command prints, in printed[1 … printed_lines]. It runs once for all its tables.
function run(command, where,    kept, failed, line) {
  if (!(command in kept_output)) {
    kept = kept_output[command] = scratch "/.output-" ++commands
    print command >(kept ".sh")
    close(kept ".sh")
    failed = system("cd '" scratch "' && bash '" kept ".sh' </dev/null >'" kept "' 2>'" kept ".err'")
    if (failed) {
      complain(where, "exit code " failed " of `" command "`:")
      while ((getline line <(kept ".err")) > 0) print line >>complaints
    }
  }
  printed_lines = 0
  while ((getline line <kept_output[command]) > 0) printed[++printed_lines] = line
  close(kept_output[command])
}

# A line of which only words and signs count.
function general(line) {
  gsub(/[0-9]+/, "#", line)
  gsub(/[ \t]+/, " ", line)
  return line
}

function beginning(line,    words) {
  split(general(line), words, " ")
  return words[1] " " words[2]
}

# Whether `…` in the line shown may stand for what is printed there.
function elided(shown, line,    parts, n, i, at) {
  n = split(shown, parts, "…")
  if (substr(line, 1, length(parts[1])) != parts[1]) return 0
  line = substr(line, length(parts[1]) + 1)
  for (i = 2; i < n; ++i) {
    at = index(line, parts[i])
    if (!at && parts[i] != "") return 0
    if (at) line = substr(line, at + length(parts[i]))
  }
  return n == 1 || (length(line) >= length(parts[n]) && substr(line, length(line) - length(parts[n]) + 1) == parts[n])
}

# What it costs to take the line printed for the one shown: less than to drop the one and to add the other, if they begin
# alike.
function difference(shown, line) {
  if (shown == line || (index(shown, "…") && elided(shown, line))) return 0
  if (general(shown) == general(line)) return 0.01
  return beginning(shown) == beginning(line) ? 0.5 : 1.5
}

# Fills way[i, j], the last step of the cheapest way (an edit distance) from the first i of the n lines shown, which begin at
# shown[first], to the first j printed: lines that `…` stands for cost nothing.
function align(first, n, way,    i, j, line, gap, cost, best) {
  for (i = 0; i <= n; ++i)
    for (j = 0; j <= printed_lines; ++j) {
      line = i ? shown[first + i - 1] : ""
      gap = line == "…" ? 0 : 1
      best = i || j ? 1e9 : 0
      if (j && cost[i, j - 1] + gap <= best) {
        best = cost[i, j - 1] + gap
        way[i, j] = gap ? "insert" : "elide"
      }
      if (i && cost[i - 1, j] + gap <= best) {
        best = cost[i - 1, j] + gap
        way[i, j] = gap ? "drop" : "keep"
      }
      if (i && j && gap && cost[i - 1, j - 1] + difference(line, printed[j]) <= best) {
        best = cost[i - 1, j - 1] + difference(line, printed[j])
        way[i, j] = "match"
      }
      cost[i, j] = best
    }
}

# The output of run() as the page shows it, which showed it as shown[first … last].
function aligned(first, last,    i, j, way, text) {
  i = last - first + 1
  j = printed_lines
  align(first, i, way)
  while (i || j) {
    if (way[i, j] == "match") {
      text = (difference(shown[first + i - 1], printed[j]) ? printed[j] : shown[first + i - 1]) "\n" text
      --i; --j
    } else if (way[i, j] == "insert") text = printed[j--] "\n" text
    else if (way[i, j] == "elide") --j
    else {
      if (way[i, j] == "keep") text = "…\n" text
      --i
    }
  }
  return text
}

# Prints block[1 … lines] with the outputs of its commands renewed.
function renew_block(lines, where,    i, command, first, text) {
  for (i = 1; i <= lines;) {
    if (block[i] !~ /^\$ /) { print block[i++]; continue }
    command = substr(block[i], 3)
    print block[i++]
    while (command ~ /\\$/) { command = command "\n" block[i]; print block[i++] }
    first = i
    while (i <= lines && block[i] !~ /^\$ /) { shown[i] = block[i]; ++i }
    delete kept_output[command]  # files may have changed since
    run(command, where)
    text = aligned(first, i - 1)
    if (text ~ /…\n…\n/) complain(where, "nothing that `" command "` prints resembles the lines between two `…`")
    printf "%s", text
  }
}

# The `which`-th Markdown table of run()'s output, in table[1 … table_lines].
function find_table(which,    i, found) {
  table_lines = 0
  for (i = 1; i <= printed_lines; ++i) {
    if (printed[i] !~ /^\|/) continue
    if (i == 1 || printed[i - 1] !~ /^\|/) ++found
    if (found == which) table[++table_lines] = printed[i]
  }
}

# Prints shown[1 … lines], a Markdown table, as the command prints it. Rows and last columns whose names are in italics
# come from elsewhere, and stay.
function renew_table(command, lines, where,    i, row, own, columns, cells, heads, kept, n) {
  run(command, where)
  find_table(++tables[command])
  if (!table_lines) complain(where, "`" command "` prints no table " tables[command])
  columns = split(shown[1], heads, / *\| */)
  for (own = columns - 1; heads[own] ~ /^\*/; --own) {}
  for (i = row = 1; i <= lines || row <= table_lines;) {
    if (i <= lines && shown[i] ~ /^\| \*/) { print shown[i++]; continue }
    if (row <= table_lines) {
      kept = ""
      n = split(shown[i], cells, / *\| */)
      for (columns = own + 1; i <= lines && columns < n; ++columns) kept = kept " " cells[columns] " |"
      print table[row++] kept
    }
    ++i
  }
}

# After a table: prints it, renewed where a command makes it.
function end_table(    i, measured) {
  if (!shown_lines) return
  if (maker != "" && (slow || !maker_slow)) renew_table(maker, shown_lines, maker_line)
  else for (i = 1; i <= shown_lines; ++i) {
    print shown[i]
    if (maker == "" && shown[i] ~ /± [0-9]/) measured = 1
  }
  if (measured) complain(NR - shown_lines, "a table with measured values, and no command above it that makes them")
  shown_lines = 0
  maker = ""
}

# A row of a Markdown table as a line of a CSV file.
function without_bars(row,    cells, n, i, line) {
  n = split(row, cells, / *\| */)
  for (i = 2; i < n; ++i) {
    if (cells[i] ~ /[,"]/) { gsub(/"/, "\"\"", cells[i]); cells[i] = "\"" cells[i] "\"" }
    line = line (i > 2 ? "," : "") cells[i]
  }
  return line
}

# Writes the next table of the command to the file, which has to be there already.
function renew_file(command, file, where, is_run,    path, i) {
  path = scratch "/" file
  if ((getline i <path) < 0) complain(where, file " is not there")
  close(path)
  if (!is_run) return
  run(command, where)
  find_table(++tables[command])
  if (!table_lines) complain(where, "`" command "` prints no table " tables[command])
  for (i = 1; i <= table_lines; ++i) if (i != 2) print without_bars(table[i]) >path
  close(path)
  print file >>(scratch "/.files")
}

function end_fence(    i) {
  if (language ~ /^ini/ && block[1] ~ /^# [a-z]+\.ini$/) {
    file = scratch "/" substr(block[1], 3)
    for (i = 1; i <= lines; ++i) print block[i] >file
    close(file)
  }
  if (language ~ / slow$/ && !slow) for (i = 1; i <= lines; ++i) print block[i]
  else renew_block(lines, fence_line)
}

fence && /^```$/ { end_fence(); fence = 0; print; next }
fence { block[++lines] = $0; next }
/^\|/ { shown[++shown_lines] = $0; next }
{ end_table() }
/^```/ {
  fence = 1; lines = 0; fence_line = NR
  language = substr($0, 4)
  if (language == "") complain(NR, "a block without a language: `console` for commands with what they print, `sh` without")
}
/^<!-- (slow )?\$ .* → [^ ]*\.csv -->$/ {
  command = file = $0
  gsub(/^<!-- (slow )?\$ | → [^ ]* -->$/, "", command)
  gsub(/^.* → | -->$/, "", file)
  renew_file(command, file, NR, slow || !/^<!-- slow /)
  print
  next
}
/^<!-- (slow )?\$ .* -->$/ {
  maker = $0
  gsub(/^<!-- (slow )?\$ | -->$/, "", maker)
  maker_line = NR
  maker_slow = /^<!-- slow /
}
/^- / && length($0) > 60 && said[$0]++ { complain(NR, "this stands in the page before") }
{ print }
END {
  end_table()
  if (fence) complain(fence_line, "this block does not end")
}
