#!/usr/bin/env bash
# Label durability: killed before and after changes to its files, killed at random times, and refused by the system, the
# program loses nothing that was committed. Only a part of the long middle of each sweep is run; sweep.sh without a
# number runs all of it.
set -euo pipefail
for tool in cc h5diff; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
every=300
bash tests/durability/sweep.sh build/credence $every &
sweep=$!
bash tests/durability/random_kills.sh build/credence 50
bash tests/durability/no_space.sh build/credence $every
wait $sweep
