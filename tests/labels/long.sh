#!/usr/bin/env bash
# Label long: the core's tests that run many trials (tagged [long]), as many at once as there are cores.
set -euo pipefail
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT
# Names may hold commas, which Catch2 takes for its own.
build/tests/credence_tests --list-test-names-only '[long]' | sed 's/[][,\\*"]/\\&/g' >"$log/names" || true
[ -s "$log/names" ] || { echo "no test is tagged [long]"; exit 1; }
status=0
xargs -d '\n' -P "$(nproc)" -I{} sh -c 'build/tests/credence_tests "$1" >"$2/$$" 2>&1 || { cat "$2/$$"; exit 1; }' - {} "$log" \
  <"$log/names" || status=$?
ran=$(grep -lE 'All tests passed|test cases: +1 ' "$log"/* | wc -l)
echo "$ran of $(wc -l <"$log/names") long tests ran"
[ "$ran" -eq "$(wc -l <"$log/names")" ] || status=1
grep -l 'SKIPPED:' "$log"/* >/dev/null 2>&1 && echo "SKIPPED: some of them"
exit $status
