#!/usr/bin/env bash
# Measures credence beside the same filter in batched numpy and JAX, after checking that all three have the same columns:
# the table "Beside numpy and JAX" of docs/performance.md. Builds build/credence, and installs numpy and JAX (some 600 MB)
# in build-bench/peers. Arguments go to bench/peers/peers.py. CREDENCE is another program to measure.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/setup.sh
if [ -z "${CREDENCE:-}" ]; then
  install_missing $build_packages python3-venv >&2
  build build credence -DCMAKE_BUILD_TYPE=Release >&2
  CREDENCE=build/credence
fi
python_venv build-bench/peers bench/peers/requirements.txt
exec build-bench/peers/bin/python bench/peers/peers.py --credence "$CREDENCE" "$@"
