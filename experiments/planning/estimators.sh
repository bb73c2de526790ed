#!/usr/bin/env bash
# Does another estimator do what no criterion does? The heading model's estimators on the fixed path and with planners
# by four criteria, in the document's world and with more heading noise: 20,000 trials each, or as many as the first
# argument says; those of a noise share their draws. Writes results/planning/estimators-*.h5 and prints the table of
# docs/theory/planning.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/planning/tables.sh
trials=${1:-20000}
estimators="ekf fej iekf riekf"
others="log_det pose_log_det max_eigenvalue"  # criteria that are compared with the trace
columns="log_score pose_error nees_ratio path_length"

# row STEM CONTROLLER ESTIMATOR: means, each beside the difference from the EKF that plans by trace, and the verdict.
row() {
  local file=$1-$2.h5 arm=fixed.$3 column
  local files=("$file" "$1-trace.h5")
  if [ "$2" != fixed ]; then arm=greedy.$3; fi
  if [ "$2" = trace ]; then files=("$file"); fi
  if [ "$2 $3" != "trace ekf" ]; then
    "$credence" compare "${files[@]}" --arms "$arm,greedy.ekf" --format csv >"$out/compared.csv"
  fi
  for column in $columns; do
    means "$1-$2.csv" "$arm" "$column"
    if [ "$2 $3" = "trace ekf" ]; then printf '| – '; else difference "$out/compared.csv" "$column"; fi
  done
  printf '| %s |\n' "$(verdict "$1-$2.csv" "$arm")"
}

{
  echo
  head="σ_head | controller | estimator"
  for column in "log score" "pose error" NEES/n "path (dm)"; do head+=" | $column | less ekf, trace"; done
  echo "| $head | verdict |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
  for sigma in 0.001 0.05 0.1; do
    stem=$out/estimators-$sigma
    for controller in trace fixed $others; do
      settings=(arms.controllers=fixed)
      if [ "$controller" != fixed ]; then settings=(arms.controllers=greedy "planner.criterion=$controller"); fi
      study "$stem-$controller" "$trials" experiments/seed/ekf-circle-ranged.ini "noise.heading=$sigma" \
        "arms.estimators=${estimators// /, }" "${settings[@]}"
    done
    for controller in fixed trace $others; do
      label=fixed
      if [ "$controller" != fixed ]; then label="greedy, $controller"; fi
      for estimator in $estimators; do
        printf '| %s | %s | %s ' "$sigma" "$label" "$estimator"
        row "$stem" "$controller" "$estimator"
      done
    done
  done
} | check_claims 20000
