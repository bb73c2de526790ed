#!/usr/bin/env bash
# The operating characteristics of the verdict: how often it is wrong about a right filter, by distribution and number
# of trials; how often it finds what is wrong; how long a right filter stays undecided. Prints the tables of
# docs/statistics.md; some 14 minutes of processor time, shared by all cores. The numbers are the same for any number of
# threads.
#
#   bash experiments/verdict/rates.sh [SHARE]      SHARE of the studies, 1 by default
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
if [ -n "${CREDENCE:-}" ]; then  # built beside that program
  built=$(dirname "$CREDENCE")
  cmake --build "$built" --target verdict_rates >&2
else
  built=build
  install_missing $build_packages >&2
  tests=()
  [ -f build/CMakeCache.txt ] || tests=(-DCREDENCE_TESTS=OFF)
  build build verdict_rates "${tests[@]}" >&2
fi
"$built/verdict_rates" "$@"
