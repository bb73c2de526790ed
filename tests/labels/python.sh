#!/usr/bin/env bash
# Label python: the Python package. Its wheel, built of the library in build/, is small and imports quickly; in a fresh
# environment it says what the program says, bit for bit; and its types and style are clean.
set -euo pipefail
python=/usr/bin/python3
$python -c 'import ensurepip, os, sysconfig; os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null ||
  { echo "SKIPPED: python3-venv or python3-dev is not installed"; exit 0; }
tree=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source tests/labels/package.sh
package_venv "$work"
source "$work/venv/bin/activate"
if [ -n "$(find "$work" -maxdepth 1 -name '*.whl' -size +10M)" ]; then
  echo "the wheel is larger than 10 MB"
  exit 1
fi

cd "$work"  # python/credence itself has no compiled module
CREDENCE=$tree/build/credence pytest -q -p no:cacheprovider "$tree/python/tests"
cd "$tree"
mypy --cache-dir "$work/mypy" python/credence
ruff check --no-cache python docs/site experiments/in_the_wild experiments/known experiments/tuning experiments/worlds experiments/budget \
  bench/peers bench/simulate_overhead.py
