#!/usr/bin/env bash
# What rounding does to NEES: the exact linear filter with ever smaller noise of its sensor, the same draws in each row.
# 20,000 trials each, or as many as the first argument says: some seconds. Prints a table of docs/theory/statistics.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
out=results/conditioning

# figure CSV SCENARIO NAME: its mean with five digits, `-` where it is left out.
figure() {
  awk -F, -v scenario="$2" -v name="$3" '$1 == scenario && $5 == name { print $7 == "" ? "-" : sprintf("%.5g", $7); exit }' "$1"
}

study $out "${1:-20000}" experiments/consistency/matched-linear.ini --sweep=sensor.sigma=1e-3,1e-5,1e-6,1e-7,5e-8,3e-8,2e-8,1e-8
"$credence" report $out.h5 --margin 99% --margin-direction 99% --format csv >$out-all.csv
echo "| sensor's σ | NEES/n | bound on its relative rounding | NEES/n of the features | bound | verdict |"
echo "|---|---|---|---|---|---|"
points $out.csv | while read -r scenario sigma; do
  printf '| %s ' "$sigma"
  for name in nees_per_dimension:all nees_rounding:all nees_per_dimension:features nees_rounding:features; do
    printf '| %s ' "$(figure $out-all.csv "$scenario" $name)"
  done
  printf '| %s |\n' "$(verdict $out.csv fixed.kf "$scenario")"
done
