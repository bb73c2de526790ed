#!/usr/bin/env bash
# Does looking further ahead pay? The document's eight cells and two with more heading noise; fixed path, greedy planner and
# a horizon of two steps on 20,000 trials each, or as many as the first argument says, then a horizon of three steps: as many
# on the straight path, a fortieth on the circle, where a step goes through two million sequences. Ten minutes on 2 cores.
# Writes results/planning/horizon-*.h5 and prints the tables of docs/planning.md.
#   experiments/planning/horizon.sh [TRIALS] [--no-costs]      --no-costs: leaves out what a step costs
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
trials=${1:-20000}
out=results/planning
names=() labels=() depths=() counts=()

# cell LABEL NAME STEPS TRIALS SCENARIO.ini [section.key=value...]
cell() {
  local label=$1 name=horizon-$3-$2 steps=$3 count=$4 scenario=$5
  shift 5
  study "$out/$name" "$count" "$scenario" "arms.controllers=fixed, greedy, horizon" "planner.horizon=$steps" "$@"
  names+=("$name") labels+=("$label") depths+=("$steps") counts+=("$count")
}

# cells STEPS: every cell with a horizon of so many steps.
cells() {
  local steps=$1 process path noise sigma count
  for process in kf ekf; do
    for path in straight circle; do
      count=$trials
      if [ "$steps $path" = "3 circle" ]; then count=$(((trials + 39) / 40)); fi
      for noise in constant ranged; do
        cell "$process, $path, $noise" "$process-$path-$noise" "$steps" "$count" "experiments/seed/$process-$path-$noise.ini"
      done
    done
  done
  for sigma in 0.01 0.05; do
    cell "ekf, circle, ranged, σ_head $sigma" "ekf-circle-ranged-$sigma" "$steps" "$count" experiments/seed/ekf-circle-ranged.ini \
      "noise.heading=$sigma"
  done
}
cells 2
cells 3

# table TITLE HEAD FUNCTION: a row for each cell.
table() {
  printf '\n%s\n\n| cell | steps | trials | %s |\n|---|---|---|%s|\n' "$1" "$2" "$(sed 's/[^|]\+/---/g' <<<"$2")"
  local i csv process
  for i in "${!names[@]}"; do
    csv=$out/${names[i]}.csv
    process=$(awk -F, 'NR == 2 { sub(/.*\./, "", $2); print $2 }' "$csv")
    printf '| %s | %s | %s %s|\n' "${labels[i]}" "${depths[i]}" "${counts[i]}" "$($3 "$csv" "greedy.$process" "horizon.$process")"
  done
}

gains() {
  local figure
  for figure in trace_P mean_trace_P; do
    printf '| %s | %s ' "$(interval "$1" "$2" $figure)" "$(interval "$1" "$3 - $2" $figure)"
  done
  for figure in unseen pose_error; do printf '| %s ' "$(interval "$1" "$3 - $2" $figure)"; done
}

credibility() {
  local arm
  for arm in "$2" "$3"; do
    printf '| %s | %s | %s ' "$(interval "$1" "$arm" nees_per_dimension:all)" \
      "$(interval "$1" "$arm" nees_per_dimension:pose)" "$(interval "$1" "$arm" rmse_ratio:all)"
  done
  printf '| %s | %s ' "$(verdict "$1" "$2")" "$(verdict "$1" "$3")"
}

table "What a longer horizon gains (horizon − greedy is by trial)" \
  "trace(P) greedy | horizon − greedy | mean trace(P) over the steps, greedy | horizon − greedy | unseen, horizon − greedy | pose error, horizon − greedy" gains
table "What it does to consistency" \
  "greedy: NEES/dim all | pose | RMSE/σ | horizon: NEES/dim all | pose | RMSE/σ | verdict greedy | horizon" credibility
if [ "${2:-}" != --no-costs ]; then
  install_missing libbenchmark-dev >&2
  build build-bench credence_bench_planning -DCMAKE_BUILD_TYPE=Release -DCREDENCE_BENCH=ON -DCREDENCE_TESTS=OFF >&2
  printf '\nWhat a step costs, statistics included\n\n'
  build-bench/credence_bench_planning
fi
