#!/usr/bin/env bash
# What credence.tune finds: prints the tables of docs/tuning.md, some ten minutes of processor time. The arguments are
# names of run.py (all): tracker, radar, document, attitude, nile. With --repetitions [NUMBER] it measures instead how
# often the truth is within two standard errors, on the gallery's program build/worlds/gallery (repetitions.py).
#
# CREDENCE_PYTHON is an interpreter that has credence and what python/requirements.txt names. Without it they are
# installed once in build/in-the-wild, credence from this tree; remove that folder to have a newer credence.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ -z "${CREDENCE_PYTHON:-}" ]; then
  source experiments/setup.sh
  python_venv build/in-the-wild python/requirements.txt .
  CREDENCE_PYTHON=$PWD/build/in-the-wild/bin/python
fi
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
if [ "${1:-}" = --repetitions ]; then
  exec "$CREDENCE_PYTHON" experiments/tuning/repetitions.py --repetitions "${2:-100}"
fi
exec "$CREDENCE_PYTHON" experiments/tuning/run.py "$@"
