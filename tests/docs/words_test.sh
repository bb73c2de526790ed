#!/usr/bin/env bash
# One word, one meaning (CONTRIBUTING.md): none of the old words below is on a page, in a message, a comment or a
# docstring. What a page has in code quotes, such as a name in a file, may stay.
# words_test.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
words=$(mktemp)
trap 'rm -f "$words" "$words.md"' EXIT
# An expression, whole words in any case, and what to write in its place.
cat >"$words" <<'END'
forks of this (one|process) = forked worker processes
(state|component) blocks? = component group
lost trials? = diverged trial
misshapen = non-chi-square
blocks? of components = component group
published figures = published numbers
END

# old_words FILE...: the lines that have one.
old_words() {
  awk '
    FILENAME == ARGV[1] { at = index($0, " = "); old[++n] = substr($0, 1, at - 1); new[n] = substr($0, at + 3); next }
    {
      text = " " tolower($0) " "
      if (FILENAME ~ /[.]md$/) gsub(/`[^`]*`/, "", text)
      for (i = 1; i <= n; ++i)
        if (text ~ ("[^a-z_](" old[i] ")[^a-z_]")) print FILENAME ":" FNR ": write \"" new[i] "\" in: " $0
    }' "$words" "$@"
}

printf '%s\n' 'Each component block.' 'In `state block`.' >"$words.md"
[ "$(old_words "$words.md" | wc -l)" -eq 1 ] || { echo "one old word of two is in code quotes: it finds another number"; exit 1; }
mapfile -d '' files < <(find README.md CHANGELOG.md CONTRIBUTING.md analysis docs include src python/credence \
  \( -name '*.md' -o -name '*.hpp' -o -name '*.cpp' -o -name '*.py' -o -name '*.html' \) -print0 | sort -z)
found=$(old_words "${files[@]}")
[ -z "$found" ] || { echo "$found"; exit 1; }
