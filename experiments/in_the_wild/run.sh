#!/usr/bin/env bash
# Judges filters that others wrote, from the examples of their libraries, beside wrong ones that must be caught. Prints a
# table, and writes the reports to results/in_the_wild; the exit code is 1 where a verdict is not the expected one, where
# NEES differs from the library's by more than 1e-9, or where a wrong filter is not named. docs/theory/in-the-wild.md
# has the table. Some ten minutes of processor time, with --short some two.
#
#   bash experiments/in_the_wild/run.sh [--short] [--page] [NAME…]     NAME: a part of a library's or study's name
#   bash experiments/in_the_wild/run.sh --causes                       what becomes of NEES where a cause is removed
#
# CREDENCE_PYTHON may name an interpreter (experiments/setup.sh).
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
credence_python
if [ "${1:-}" = --causes ]; then exec "$CREDENCE_PYTHON" experiments/in_the_wild/causes.py; fi
exec "$CREDENCE_PYTHON" experiments/in_the_wild/run.py --reports results/in_the_wild "$@"
