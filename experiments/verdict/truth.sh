#!/usr/bin/env bash
# The verdict where the truth has errors of its own: prints truth.csv and truth-logs.csv, two tables of
# docs/theory/statistics.md; some five minutes of processor time. The numbers are the same on every machine whose
# standard library draws alike.
#
#   bash experiments/verdict/truth.sh [STUDIES]      STUDIES a cell, 24 by default
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/verdict/program.sh verdict_truth
for table in cells logs; do
  "$built/verdict_truth" $table "$@" | sed -e 's/,/ | /g' -e 's/.*/| & |/' -e '1a |---|'
  echo
done
