#!/usr/bin/env bash
# What the include rule cannot see. Objects: none refers to a symbol that only a later module defines. Comments: every
# file that one names is there, and so is every name with an underscore that one quotes (but for placeholders in
# capitals). Decisions: no text that is printed is compared with a literal to decide anything.
# references_test.sh SOURCE_FOLDER BUILD_FOLDER
set -euo pipefail
cd "$1"
build=$2
status=0
modules=$(sed -n 's/^modules="\(.*\)"$/\1/p' tests/modules_test.sh)

# Of src/study/run.cpp the object is src/.../study/run.cpp.o, or with others of its folder Unity/unity_study_cxx.cxx.o.
find "$build/src" -name '*.o' | while read -r object; do
  module=$(sed -E 's#.*/CMakeFiles/[^/]*/(Unity/unity_)?##; s#[/_.].*##' <<<"$object")
  nm "$object" | sed "s#^#$module #"
done | awk -v modules="$modules" '
  BEGIN { n = split(modules, list, " "); for (i = 1; i <= n; ++i) place[list[i]] = i }
  !($1 in place) || $NF !~ /credence/ { next }
  $(NF-1) == "U" { used[$1 " " $NF]; next }
  $(NF-1) ~ /^[TDBR]$/ && (!($NF in home) || place[$1] < place[home[$NF]]) { home[$NF] = $1 }
  END {
    for (use in used) {
      split(use, part, " ")
      if (!(part[2] in home)) continue
      ++checked
      if (place[home[part[2]]] > place[part[1]]) { print part[1] " uses of " home[part[2]] ", which comes after it: " part[2]; bad = 1 }
    }
    if (checked < 500) { print "only " checked + 0 " references were found"; bad = 1 }
    exit bad
  }' | c++filt || status=1

sources=$(find src include -name '*.[ch]pp')
files=$(find src include python experiments analysis tests bench cmake docs -type f; ls)
awk -v files="$files" '
  # The comment of a line; "" without one.
  function comment_of(line,  at) {
    return match(line, /^([^"\/]|"([^"\\]|\\.)*"|\/[^\/])*\/\//) ? substr(line, RLENGTH) : ""
  }
  BEGIN {
    n = split(files, list, "\n")
    for (i = 1; i <= n; ++i) {  # a file by its name, and by each end of its path
      path = list[i]
      known[path]
      while (sub(/^[^\/]*\//, "", path)) known[path]
    }
  }
  pass == 1 {
    line = $0
    text = comment_of(line)
    if (text != "") line = substr(line, 1, length(line) - length(text) - 1)
    while (match(line, /[A-Za-z_][A-Za-z0-9_]*/)) { word[substr(line, RSTART, RLENGTH)]; line = substr(line, RSTART + RLENGTH) }
    next
  }
  {
    text = rest = comment_of($0)
    while (match(rest, /[A-Za-z0-9_\/.-]+\.(hpp|cpp|md|sh|py|awk|css|cmake)/)) {
      name = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH)
      ++checked
      if (!(name in known)) { print FILENAME ":" FNR ": there is no file " name; bad = 1 }
    }
    rest = text
    while (match(rest, /`[^`]*`/)) {
      quoted = substr(rest, RSTART + 1, RLENGTH - 2)
      rest = substr(rest, RSTART + RLENGTH)
      while (match(quoted, /[A-Za-z_][A-Za-z0-9_]*/)) {
        name = substr(quoted, RSTART, RLENGTH)
        quoted = substr(quoted, RSTART + RLENGTH)
        if (name !~ /_/ || name ~ /[A-Z][A-Z]/) continue
        ++checked
        if (!(name in word)) { print FILENAME ":" FNR ": nothing is named " name; bad = 1 }
      }
    }
  }
  END { if (checked < 150) { print "only " checked + 0 " names were found in comments"; bad = 1 }; exit bad }
' pass=1 $sources pass=2 $sources || status=1

decided=$(grep -nE '(what|message|reason|sentence)(\(\))? (==|!=) "' $sources || true)
[ -z "$decided" ] || { echo "a printed text decides:"; echo "$decided"; status=1; }
exit $status
