#!/usr/bin/env bash
# Label long: the tests that run many trials: those of the core's program that are tagged [long], and all tests of a
# separate program, as many at once as there are cores.
set -euo pipefail
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT
cmake --build build --target credence_long_tests -j "$(nproc)" >"$log/build" 2>&1 || { tail -n 60 "$log/build"; exit 1; }
# names PROGRAM [TAG]: its tests, one a line after the program's name; names may contain commas, which separate tests
# for Catch2.
names() {
  "build/tests/$1" --list-test-names-only ${2:+"$2"} | sed -e 's/[][,\\*"]/\\&/g' -e "s/^/$1 /" || true
}
# (In this order none that takes long is left over at the end.)
{ names credence_long_tests | tac; names credence_tests '[long]'; } >"$log/names"
for program in credence_tests credence_long_tests; do
  grep -q "^$program " "$log/names" || { echo "$program has no long test"; exit 1; }
done
status=0
xargs -d '\n' -P "$(nproc)" -I{} sh -c 'build/tests/"${1%% *}" "${1#* }" >"$2/ran.$$" 2>&1 || { cat "$2/ran.$$"; exit 1; }' \
  - {} "$log" <"$log/names" || status=$?
ran=$(grep -lE 'All tests passed|test cases: +1 ' "$log"/ran.* | wc -l)
echo "$ran of $(wc -l <"$log/names") long tests ran"
[ "$ran" -eq "$(wc -l <"$log/names")" ] || status=1
grep -l 'SKIPPED:' "$log"/ran.* >/dev/null 2>&1 && echo "SKIPPED: some of them"
exit $status
