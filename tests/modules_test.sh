#!/usr/bin/env bash
# The include rule: a module includes itself and those before it, never one after it. Its order is that of the list
# below, which CONTRIBUTING.md explains. A source's module is its folder in src; a public header names its own in its
# first comment. Public headers include no private ones, are 17 at most, and each compiles alone. No line of the product is
# longer than 120 columns.
# modules_test.sh SOURCE_FOLDER CXX EIGEN_FOLDER
set -euo pipefail
cd "$1"
cxx=$2 eigen=$3
modules="base numeric scenario statistics totals slam engine worlds verdict record study files report cli"
status=0

public=$(find include/credence -name '*.hpp')
unnamed=$(grep -LE "^// Module (${modules// /|}): " $public || true)
[ -z "$unnamed" ] || { echo "public headers that name no module: $unnamed"; status=1; }

# Every include of the project's own files, with the modules of both sides.
find src include -name '*.[ch]pp' | xargs grep -nE '^#include ["<][a-z0-9_/]+\.hpp[">]|^// Module [a-z]+: ' |
  awk -v modules="$modules" '
    BEGIN { n = split(modules, list, " "); for (i = 1; i <= n; ++i) place[list[i]] = i }
    function file_of(name) { return name ~ /^credence\// ? "include/" name : "src/" name }
    {
      split($0, part, ":")
      path = part[1]
      if ($0 ~ /:\/\/ Module /) { sub(/.*:\/\/ Module /, ""); sub(/:.*/, ""); named[path] = $0; next }
      name = $0; sub(/^[^"<]*["<]/, "", name); sub(/[">].*/, "", name)
      from[++count] = path; line[count] = part[2]; to[count] = file_of(name)
    }
    function module_of(path,  part) {
      if (path ~ /^include/) return named[path]
      split(path, part, "/")
      return part[2]
    }
    END {
      for (i = 1; i <= count; ++i) {
        a = module_of(from[i]); b = module_of(to[i])
        if (!(a in place) || !(b in place)) continue
        ++checked
        if (place[b] > place[a]) { print from[i] ":" line[i] ": the module " a " includes " to[i] " of " b ", which comes after it"; bad = 1 }
        if (from[i] ~ /^include/ && to[i] ~ /^src/) { print from[i] ":" line[i] ": a public header includes a private one, " to[i]; bad = 1 }
      }
      if (checked < 500) { print "only " checked " includes were found"; bad = 1 }
      exit bad
    }' || status=1

long=$(find src include -name '*.[ch]pp' -exec awk '
  { line = $0; gsub(/[\200-\277]/, "", line) } length(line) > 120 { print FILENAME ":" FNR ": more than 120 columns" }' {} +)
[ -z "$long" ] || { echo "$long"; status=1; }
promised=$(find include/credence -maxdepth 1 -name '*.hpp')
[ "$(echo "$promised" | wc -l)" -le 17 ] || { echo "more than 17 public headers"; status=1; }
[ "$(find src -mindepth 1 -maxdepth 1 -type d | wc -l)" -eq 14 ] || { echo "src does not have fourteen folders"; status=1; }
echo "$promised" | xargs -P 2 -I{} "$cxx" -std=c++20 -fsyntax-only -Iinclude -isystem "$eigen" -include {} -x c++ /dev/null || status=1
exit $status
