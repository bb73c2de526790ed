#!/usr/bin/env bash
# Runs everything here, and first that each harness notices the bugs that are planted for it. Prints a line for each.
# usage: all.sh CREDENCE [DEPTH]
#   sample   some of each, in minutes: the label durability
#   evening  more of each, in about two hours
#   full     every chain of 12 callers of an allocation, every byte of two small results files, every folder: about a day
# After the last two the lines are kept in counts.txt, which docs/durability.md shows.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
credence=$(realpath "$1")
depth=${2:-full}
case $depth in
  sample)
    sweep=300 kills=50 folders="--some 1 --every 16" calls="--most 1" streams="--every 7" bytes="--every 20011" turns=44
    ;;
  evening)
    sweep=20 kills=100 folders="--some 10" calls="--most 20 --callers 3" streams= bytes="--every 401" turns=1000
    ;;
  full)
    sweep=1 kills=200 folders="--some 60" calls="--most 200 --callers 12" streams= bytes="--every 41" turns=10000
    ;;
  *) echo "unknown depth $depth (sample, evening and full are those there are)" >&2; exit 2 ;;
esac

harnesses() {
  python3 "$here/interleave.py" "$credence" --mutants 1
  python3 "$here/corruption.py" "$credence" --every 997 --mutants 1
  python3 "$here/fail_once.py" "$credence" --mutants 1
  python3 "$here/descriptors.py" "$credence" --mutants 1
  python3 "$here/versions.py" "$credence" --mutants 1
  [ "$depth" = sample ] || python3 "$here/power_loss.py" "$credence" --mutants 1
  python3 "$here/power_loss.py" "$credence" $folders
  python3 "$here/fail_once.py" "$credence" $calls
  python3 "$here/descriptors.py" "$credence" $streams
  python3 "$here/corruption.py" "$credence" $bytes
  python3 "$here/interleave.py" "$credence" --schedules $turns
  python3 "$here/versions.py" "$credence"
  if [ "$depth" = sample ]; then return; fi
  if command -v valgrind >/dev/null; then
    python3 "$here/memcheck.py" "$credence"
  else
    echo "SKIPPED: valgrind is not installed" >&2
  fi
  if [ "$depth" = full ]; then each_byte; fi
}

# The reader of results files alone, in its test's own processes.
each_byte() {
  local tests said
  tests=$(dirname "$credence")/tests/credence_long_tests
  if [ ! -x "$tests" ]; then echo "SKIPPED: $tests is not built" >&2 && return; fi
  said=$(mktemp)
  CREDENCE_FLIP_EVERY=1 "$tests" 'store: a results file of which any byte is flipped*' >"$said" ||
    { cat "$said" >&2; return 1; }
  grep '^each byte' "$said"
  rm "$said"
}

# Kills and refusals at chosen writes, and at random times.
scripts() {
  bash "$here/sweep.sh" "$credence" $sweep
  bash "$here/random_kills.sh" "$credence" $kills
  bash "$here/no_space.sh" "$credence" $sweep
}

lines=$(mktemp)
trap 'rm -f "$lines"' EXIT
harnesses | grep --line-buffered -v '^  ' | tee -a "$lines"
scripts | tee -a "$lines"
# What is counted is what the page shows.
cut -d: -f1 "$lines" | while read -r name; do
  if [ "$depth" = sample ] && ! grep -q "^$name:" "$here/counts.txt"; then
    echo "FAILED: counts.txt lacks: $name" >&2
    exit 1
  fi
done
if [ "$depth" != sample ]; then
  { echo "$("$credence" --version | head -n 1), depth $depth"; cat "$lines"; } >"$here/counts.txt"
fi
