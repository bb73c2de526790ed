#!/usr/bin/env bash
# The verdict where the truth has errors of its own: writes truth.csv and truth-logs.csv beside this script, of
# docs/theory/statistics.md; some five minutes of processor time. The numbers are the same on every machine whose
# standard library draws alike.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/verdict/program.sh verdict_truth
"$built/verdict_truth" cells >experiments/verdict/truth.csv
"$built/verdict_truth" logs >experiments/verdict/truth-logs.csv
