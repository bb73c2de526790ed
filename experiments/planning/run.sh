#!/usr/bin/env bash
# Does planning pay, on which paths and noises, and what does it do to consistency? The document's eight cells, larger
# heading noise, and a world that the filter assumes, planned and fixed; 100,000 trials each (some minutes on 2 cores),
# or as many as the first argument says. Writes results/planning/*.h5 and prints the tables of docs/theory/planning.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/planning/tables.sh
trials=${1:-100000}

# cell LABEL NAME SCENARIO.ini [section.key=value...]
cell() {
  local label=$1 name=$2 scenario=$3
  shift 3
  study "$out/$name" "$trials" "$scenario" "$@"
  stems+=("$out/$name") labels+=("$label")
}

for process in kf ekf; do
  for path in straight circle; do
    for noise in constant ranged; do
      cell "$process, $path, $noise" "$process-$path-$noise" "experiments/seed/$process-$path-$noise.ini"
    done
  done
done
for sigma in 0.01 0.05 0.1; do
  cell "ekf, circle, ranged, σ_head $sigma" "ekf-circle-ranged-$sigma" experiments/seed/ekf-circle-ranged.ini "noise.heading=$sigma"
done
cell "ekf, circle, ranged, matched truth" matched experiments/planning/matched-circle.ini
cell "the same, σ_head 0.05" matched-0.05 experiments/planning/matched-circle.ini noise.heading=0.05

median() { awk -F, -v arm="$2" '$2 == arm && $5 == "trace_P" { printf "%.2g", $13 }' "$1"; }

gains() {
  local gain="$3 - $2" figure
  printf '| %s | %s | %s ' "$(interval "$1" "$2" trace_P)" "$(interval "$1" "$gain" trace_P)" "$(median "$1" "$gain")"
  for figure in mean_trace_P pose_error; do
    printf '| %s | %s ' "$(interval "$1" "$2" $figure)" "$(interval "$1" "$gain" $figure)"
  done
  printf '| %s ' "$(interval "$1" "$gain" unseen)"
}

{
  table "What planning gains ($trials trials each; planned − fixed is by trial)" \
    "cell | trace(P) fixed | planned − fixed | its median | mean trace(P) over the steps, fixed | planned − fixed | pose error, fixed | planned − fixed | unseen, planned − fixed" \
    gains fixed greedy
  table "What it does to consistency" \
    "cell | fixed: NEES/dim all | pose | RMSE/σ | planned: NEES/dim all | pose | RMSE/σ | verdict fixed | planned" \
    credibility fixed greedy
} | check_claims 100000
