#!/usr/bin/env bash
# Label docs: every output and table of README.md and docs that takes minutes to reproduce; the core tests check the
# others.
set -euo pipefail
/usr/bin/python3 -c 'import h5py, scipy, matplotlib, PIL' 2>/dev/null ||
  { echo "SKIPPED: python3-h5py, python3-scipy, python3-matplotlib or python3-pil is not installed"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{ cmake --install build --prefix "$work/usr" &&
  cmake -S experiments/own_filter -B "$work/build" -DCMAKE_PREFIX_PATH="$work/usr" && cmake --build "$work/build"; } \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
PYTHON=/usr/bin/python3 FURTHER_PROGRAMS="$work/build/tracker" bash tests/docs/check.sh --slow "$@"
