#!/usr/bin/env bash
# What credence.tune finds: prints the tables of docs/tuning.md, some ten minutes of processor time. The arguments are
# names of run.py (all): tracker, radar, document, attitude, nile. With --repetitions [NUMBER] it measures instead how
# often the truth is within two standard errors, on the gallery's program build/worlds/gallery (repetitions.py); with
# --statements how often what is said is wrong where a tune cannot know (statements.py).
#
# CREDENCE_PYTHON may name an interpreter (experiments/setup.sh).
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
credence_python
if [ "${1:-}" = --repetitions ]; then
  exec "$CREDENCE_PYTHON" experiments/tuning/repetitions.py --repetitions "${2:-100}"
fi
if [ "${1:-}" = --statements ]; then
  exec "$CREDENCE_PYTHON" experiments/tuning/statements.py --output experiments/tuning/statements.csv
fi
exec "$CREDENCE_PYTHON" experiments/tuning/run.py "$@"
