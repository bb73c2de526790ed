#!/usr/bin/env bash
# Runs everything here, and that each harness notices the bugs that are planted for it. Prints a line for each.
# usage: all.sh CREDENCE [DEPTH]
#   sample   some of each but of what is in shelf/, in minutes: the label durability
#   evening  more of each, in about an hour
#   full     every chain of 8 callers of an allocation, every byte of two small results files, every change of a file:
#            hours
# As many harnesses run at a time as there are processors. The last two depths keep the lines in counts.txt.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
credence=$(realpath "$1")
depth=${2:-full}
case $depth in
  sample)
    sweep=300 kills=50 folders="--some 1 --every 16" calls="--most 1 --many 1 --every 4"
    bytes="--every 20011"
    ;;
  evening)
    sweep=20 kills=100 folders="--some 10" calls="--most 20 --many 20 --callers 3"
    bytes="--every 401" turns=1000
    ;;
  full)
    sweep=1 kills=200 folders="--some 30" calls="--many 50 --callers 8"
    bytes="--every 101" turns=4000
    ;;
  *) echo "unknown depth $depth (sample, evening and full are those there are)" >&2; exit 2 ;;
esac

parts=(  # that with the most calls first, so that no processor waits for it at the end
  "harness fail_once $calls"
  "harness corruption --every 997 --mutants 1"
  "harness fail_once --mutants 1"
  "harness versions --mutants 1"
  "harness power_loss $folders"
  "harness corruption $bytes"
  "harness versions"
  "script sweep $sweep"  # kills and refusals at chosen writes, and at random times
  "script random_kills $kills"
  "script no_space $sweep"
)
long_tests=$(dirname "$credence")/tests/credence_long_tests
if [ "$depth" != sample ]; then
  command -v valgrind >/dev/null || { echo "valgrind is not installed" >&2; exit 2; }
  parts+=("harness power_loss --mutants 1" "shelf interleave --mutants 1 --seed 2" "shelf interleave --schedules $turns"
    "shelf descriptors --mutants 1" "shelf descriptors" "shelf memcheck")
fi
if [ "$depth" = full ]; then
  [ -x "$long_tests" ] || { echo "$long_tests is not built" >&2; exit 2; }
  parts=(each_byte "${parts[@]}")
fi

harness() { python3 "$here/$1.py" "$credence" "${@:2}"; }
shelf() { PYTHONPATH=$here python3 "$here/shelf/$1.py" "$credence" "${@:2}"; }
script() { bash "$here/$1.sh" "$credence" "${@:2}"; }

# The reader of results files alone, in its test's own processes.
each_byte() {
  local said=$kept/each_byte.log
  CREDENCE_FLIP_EVERY=1 "$long_tests" 'store: a results file of which any byte is flipped*' >"$said" ||
    { cat "$said" >&2; return 1; }
  grep '^each byte' "$said"
}

# Prints the lines of a part, but for those that say how far it is, and keeps them under the part's number.
run_part() {
  $2 | grep --line-buffered -v '^  ' | tee "$kept/$1.lines" || : >"$kept/failed"
}

kept=$(mktemp -d)
trap 'rm -rf "$kept"' EXIT
for number in "${!parts[@]}"; do
  while [ "$(jobs -pr | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
  run_part "$(printf %02d "$number")" "${parts[number]}" &
done
wait
[ ! -e "$kept/failed" ] || exit 1

if [ "$depth" != sample ]; then
  { echo "$("$credence" --version | head -n 1), depth $depth"; cat "$kept"/*.lines; } >"$here/counts.txt"
fi
cat "$kept"/*.lines | cut -d: -f1 | while read -r name; do
  grep -q "^$name:" "$here/counts.txt" || { echo "FAILED: counts.txt lacks: $name" >&2; exit 1; }
done
