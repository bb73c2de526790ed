#!/usr/bin/env bash
# Prints the tables of docs/budget.md: `circle`, `tracker` or `coverage`. CREDENCE_PYTHON may name an interpreter
# (experiments/setup.sh).
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
credence_python
exec "$CREDENCE_PYTHON" "experiments/budget/$1.py" "${@:2}"
