#!/usr/bin/env bash
# check.sh [--slow] [--update] [PAGE...]: whether README.md, docs/theory/*.md and docs/*.md, or these pages, show what
# their commands print. With --update the pages are rewritten; with --slow what takes minutes is run as well. CREDENCE
# is the program (build/credence); FURTHER_PROGRAMS, parted by spaces, are others that a page calls as build/NAME.
#
# What is run, in the order of the page, in a folder of each page's own with the project's experiments, analysis, bench,
# python and docs/theory in it:
#
#   ```console                   A block whose lines begin with `$ ` shows commands, each with its standard output below.
#   $ credence report a.h5       A line `…` stands for any lines, and `…` in a line for anything there.
#   …
#   ```
#   <!-- $ bash study.sh -->     The Markdown table below is the first that the command prints; below the next comment with
#   | … |                        the same command is its second. Rows and last columns whose names are in italics are not
#                                the command's.
#   <!-- $ bash study.sh → experiments/study.csv -->
#                                The file, which is too long for the page, is that table.
#   ```console slow              Both forms, run with --slow only.
#   <!-- slow $ bash study.sh -->
#   ```ini                       A scenario whose first line is its name is a file that commands below may read.
#   # own.ini
#
# Beyond that it complains of blocks without a language, tables with ± and no command, bullets that are there twice, and
# lines of more than 120 characters outside code, tables, HTML and pictures, and without a URL.
set -euo pipefail
cd "$(dirname "$0")/../.."
slow=0 update=0
while [[ ${1:-} == --* ]]; do
  case $1 in
    --slow) slow=1 ;;
    --update) update=1 ;;
    *) echo "unknown option $1 (--slow and --update are those there are)" >&2; exit 2 ;;
  esac
  shift
done
pages=("$@")
[ $# -gt 0 ] || pages=(README.md docs/theory/*.md docs/*.md)  # pages of docs show rows of those of docs/theory
CREDENCE=$(realpath "${CREDENCE:-build/credence}")
export CREDENCE
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

status=0
for page in "${pages[@]}"; do
  scratch=$folder/$(tr / _ <<<"${page%.md}") complaints=$folder/complaints renewed=$folder/renewed
  mkdir -p "$scratch/build" "$scratch/docs/figures"
  cp -r experiments analysis bench python "$scratch"
  cp -r docs/theory "$scratch/docs"
  ln -s "$CREDENCE" "$scratch/build/credence"
  for program in ${FURTHER_PROGRAMS:-}; do ln -s "$(realpath "$program")" "$scratch/build"; done
  : >"$complaints"
  PATH=$scratch/build:$PATH awk -v scratch="$scratch" -v slow=$slow -v complaints="$complaints" \
    -f tests/docs/renew.awk "$page" >"$renewed"
  # In UTF-8, bytes that continue a character do not count.
  LC_ALL=C awk -v page="$page" '
    /^```/ { code = !code }
    code || /^[|<!]/ || /https?:/ { next }
    { gsub(/[\200-\277]/, ""); if (length > 120) print page ":" FNR ": a line of " length " characters" }' \
    "$page" >>"$complaints"
  if [ -s "$complaints" ]; then
    cat "$complaints"
    status=1
  elif ! cmp -s "$page" "$renewed"; then
    diff -u --label "$page" --label "$page, as its commands print it" "$page" "$renewed" || true
    if [ $update -eq 1 ]; then cat "$renewed" >"$page"; else status=1; fi
  fi
  if [ -e "$scratch/.files" ]; then
    while read -r file; do
      diff -u --label "$file" --label "$file, as its command prints it" "$file" "$scratch/$file" && continue
      if [ $update -eq 1 ]; then cp "$scratch/$file" "$file"; else status=1; fi
    done <"$scratch/.files"
  fi
  rm -rf "$scratch"
done
if [ $status -ne 0 ] && [ $update -eq 0 ]; then
  echo "Where the program is right: bash tests/docs/check.sh --update$([ $slow -eq 0 ] || echo ' --slow')"
fi
exit $status
