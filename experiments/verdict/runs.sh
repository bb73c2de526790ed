#!/usr/bin/env bash
# The verdict on few runs, counted by segments, and on few or short trials: writes the tables runs-*.csv beside this
# script, of docs/theory/statistics.md; some ten minutes of processor time. The numbers are the same on every machine
# whose standard library draws alike.
#
#   bash experiments/verdict/runs.sh [TABLE …]      units right logs short components innovations
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/verdict/program.sh verdict_runs
declare -A studies=([units]=12 [right]=25 [logs]=20 [short]=60 [components]=25 [innovations]=60)
for table in ${*:-units right logs short components innovations}; do
  "$built/verdict_runs" "$table" "${studies[$table]}" >"experiments/verdict/runs-$table.csv"
done
