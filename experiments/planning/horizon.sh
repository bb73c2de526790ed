#!/usr/bin/env bash
# Does looking further ahead pay? The document's eight cells, and three with more heading noise: fixed path, greedy
# planner and a horizon of two steps on 20,000 trials each, or as many as the first argument says. Then the eight with
# three steps: as many trials on the straight path, a fortieth on the circle, where there are two million sequences. And
# two steps by the determinant, on five times as many trials.
# Half an hour on 2 cores. Writes results/planning/horizon-*.h5 and prints the tables of docs/theory/planning.md.
#   experiments/planning/horizon.sh [TRIALS] [--no-costs]      --no-costs: leaves out what a step costs
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/planning/tables.sh
trials=${1:-20000}

# cell LABEL NAME STEPS TRIALS SCENARIO.ini [section.key=value...]
cell() {
  local label=$1 name=horizon-$3-$2 steps=$3 count=$4 scenario=$5
  shift 5
  study "$out/$name" "$count" "$scenario" "arms.controllers=fixed, greedy, horizon" "planner.horizon=$steps" "$@"
  stems+=("$out/$name") labels+=("$label | $steps | $count")
}

# cells STEPS: the eight cells with a horizon of so many steps.
cells() {
  local steps=$1 process path noise count
  for process in kf ekf; do
    for path in straight circle; do
      count=$trials
      if [ "$steps $path" = "3 circle" ]; then count=$(((trials + 39) / 40)); fi
      for noise in constant ranged; do
        cell "$process, $path, $noise" "$process-$path-$noise" "$steps" "$count" "experiments/seed/$process-$path-$noise.ini"
      done
    done
  done
}
cells 2
for sigma in 0.01 0.05 0.1; do
  cell "ekf, circle, ranged, σ_head $sigma" "ekf-circle-ranged-$sigma" 2 "$trials" experiments/seed/ekf-circle-ranged.ini \
    "noise.heading=$sigma"
done
cells 3
for sigma in 0.001 0.05 0.1; do
  cell "log_det: ekf, circle, ranged, σ_head $sigma" "log-det-$sigma" 2 $((5 * trials)) \
    experiments/seed/ekf-circle-ranged.ini planner.criterion=log_det "noise.heading=$sigma"
done

gains() {
  local figure
  for figure in trace_P mean_trace_P; do
    printf '| %s | %s ' "$(interval "$1" "$2" $figure)" "$(interval "$1" "$3 - $2" $figure)"
  done
  for figure in unseen pose_error; do printf '| %s ' "$(interval "$1" "$3 - $2" $figure)"; done
}

{
  table "What a longer horizon gains (horizon − greedy is by trial)" \
    "cell | steps | trials | trace(P) greedy | horizon − greedy | mean trace(P) over the steps, greedy | horizon − greedy | unseen, horizon − greedy | pose error, horizon − greedy" \
    gains greedy horizon
  table "What it does to consistency" \
    "cell | steps | trials | greedy: NEES/dim all | pose | RMSE/σ | horizon: NEES/dim all | pose | RMSE/σ | verdict greedy | horizon" \
    credibility greedy horizon
} | check_claims 20000
if [ "${2:-}" != --no-costs ]; then
  install_missing libbenchmark-dev >&2
  build build-bench credence_bench_planning -DCMAKE_BUILD_TYPE=Release -DCREDENCE_BENCH=ON -DCREDENCE_TESTS=OFF >&2
  printf '\nWhat a step costs, statistics included\n\n'
  build-bench/credence_bench_planning
fi
