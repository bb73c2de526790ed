#!/usr/bin/env bash
# The operating characteristics of the verdict: how often it is wrong about a right filter, by distribution and number
# of trials; how often it finds what is wrong; how long a right filter stays undecided. Prints the tables of
# docs/theory/statistics.md; some 50 minutes of processor time, shared by all cores. The numbers are the same for any
# number of threads.
#
#   bash experiments/verdict/rates.sh [SHARE]      SHARE of the studies, 1 by default
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/verdict/program.sh verdict_rates
"$built/verdict_rates" "$@"
