#!/usr/bin/env bash
# How often the 95 % interval of NEES/n covers the truth in the worlds of the studies, and how often a verdict on few
# trials claims what that on many denies. Prints a table of docs/theory/statistics.md; some two minutes of processor
# time, shared by all cores. The numbers are the same for any number of threads.
#
#   bash experiments/verdict/coverage.sh [SHARE]      SHARE of the studies and trials, 1 by default
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/verdict/program.sh verdict_coverage
"$built/verdict_coverage" "$@"
