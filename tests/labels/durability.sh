#!/usr/bin/env bash
# Label durability: a sample of what `tests/durability/all.sh` runs: power fails, each resource fails once, bytes flip; the
# program is killed before and after changes to its files and at random times, and refused by the system. It loses
# nothing that was committed.
set -euo pipefail
for tool in cc h5diff h5dump python3; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
bash tests/durability/all.sh build/credence sample
