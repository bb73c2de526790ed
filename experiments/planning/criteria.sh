#!/usr/bin/env bash
# Which criterion buys what? The planner by each of its criteria, and the controllers that do not plan, in the document's
# world, in the matched one, with more heading noise and among landmarks: 20,000 trials each, or as many as the first
# argument says; those of a world share their draws. Writes results/planning/criteria-*.h5 and prints the tables of
# docs/theory/planning.md; with PICTURE=FILE.png, and matplotlib (PYTHON, python3), it draws the picture of
# docs/planning.md as well.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/planning/tables.sh
trials=${1:-20000}
baselines="fixed random nearest follow"
criteria="trace log_det max_eigenvalue pose_trace pose_log_det features_trace"
columns="trace_P unseen pose_error nees_ratio"

# world LABEL NAME SCENARIO.ini [section.key=value...]: a study of the baselines, and one of each criterion.
world() {
  local label=$1 stem=$out/criteria-$2 scenario=$3 criterion
  shift 3
  study "$stem-baselines" "$trials" "$scenario" "arms.controllers=${baselines// /, }" "$@"
  for criterion in $criteria; do
    study "$stem-$criterion" "$trials" "$scenario" arms.controllers=greedy "planner.criterion=$criterion" "$@"
  done
  labels+=("$label") stems+=("$stem")
}

world "document" document experiments/seed/ekf-circle-ranged.ini
world "matched truth" matched experiments/planning/matched-circle.ini
for sigma in 0.01 0.05 0.1; do
  world "σ_head $sigma" "$sigma" experiments/seed/ekf-circle-ranged.ini "noise.heading=$sigma"
done
world "landmark loop" landmarks experiments/planning/landmark-loop.ini

# row WORLD CONTROLLER STEM ARM: the means of an arm, and its verdict.
row() {
  printf '| %s | %s %s| %s |\n' "$1" "$2" "$(means "$3.csv" "$4" $columns log_score path_length)" \
    "$(verdict "$3.csv" "$4")"
}

# less WORLD CONTROLLER STEM FILE.h5 ARM: the arm less the planner by trace, by trial.
less() {
  local column
  "$credence" compare "$4" "$3-trace.h5" --arms "$5,greedy" --format csv >"$out/compared.csv"
  printf '| %s | %s ' "$1" "$2"
  for column in $columns; do difference "$out/compared.csv" "$column"; done
  echo "|"
}

head="world | controller | trace(P) | unseen | pose error | NEES/n"
{
  printf '\nEach controller by itself (%s trials each)\n\n| %s | log score | path (dm) | verdict |\n' "$trials" "$head"
  echo '|---|---|---|---|---|---|---|---|---|'
  for i in "${!stems[@]}"; do
    for controller in $baselines; do row "${labels[i]}" "$controller" "${stems[i]}-baselines" "$controller.ekf"; done
    for criterion in $criteria; do row "${labels[i]}" "greedy, $criterion" "${stems[i]}-$criterion" greedy.ekf; done
  done
  printf '\nLess the planner by trace, trial by trial\n\n| %s |\n|---|---|---|---|---|---|\n' "$head"
  for i in "${!stems[@]}"; do
    stem=${stems[i]}
    for controller in $baselines; do less "${labels[i]}" "$controller" "$stem" "$stem-baselines.h5" "$controller"; done
    for criterion in ${criteria#trace }; do
      less "${labels[i]}" "greedy, $criterion" "$stem" "$stem-$criterion.h5" greedy
    done
  done
} | check_claims 20000
if [ -n "${PICTURE:-}" ]; then
  PYTHONPATH=python "${PYTHON:-python3}" experiments/planning/picture.py "$out" "$PICTURE"
fi
