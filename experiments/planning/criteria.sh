#!/usr/bin/env bash
# Which criterion buys what? The planner by each of its criteria, and the controllers that do not plan, in the document's
# world, in the matched one, with more heading noise and among landmarks: 20,000 trials each, or as many as the first
# argument says; those of a world share their draws. Writes results/planning/criteria-*.h5 and prints the tables of
# docs/theory/planning.md. Needs numpy and h5py (PYTHON, python3) for the columns of 100 replayed trials; with
# PICTURE=FILE.png, and matplotlib, it draws the picture of docs/planning.md as well.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
source experiments/planning/tables.sh
build_program >&2
trials=${1:-20000}
out=results/planning
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

# row WORLD CONTROLLER STEM ARM: the means of an arm, those of its replayed trials, and its verdict.
row() {
  local column
  printf '| %s | %s ' "$1" "$2"
  for column in $columns; do printf '| %s ' "$(interval "$3.csv" "$4" "$column")"; done
  printf '| %s ' "$("${PYTHON:-python3}" experiments/planning/paths.py "$credence" 100 "$3.h5" "$4")"
  printf '| %s |\n' "$(verdict "$3.csv" "$4")"
}

# difference WORLD CONTROLLER STEM FILE.h5 ARM: the arm less the planner by trace, by trial with 95 % intervals.
# Differences that are certain are bold: beyond 3.7 standard errors, which is Bonferroni's bound for the 6 worlds,
# 9 controllers and 4 columns of this table together (0.05/216, two-sided).
difference() {
  printf '| %s | %s ' "$1" "$2"
  "$credence" compare "$4" "$3-trace.h5" --arms "$5,greedy" --format csv | awk -F, -v columns="$columns" '
    NR > 1 {
      half = 1.96 * $10
      digits = half > 0 ? 1 - int(log(half) / log(10) - (half < 1)) : 4
      mark = $9 * $9 > 3.7 * 3.7 * $10 * $10 ? "**" : ""
      text[$4] = sprintf("%s%.*f ± %.*f%s", mark, digits < 0 ? 0 : digits, $9, digits < 0 ? 0 : digits, half, mark)
    }
    END {
      count = split(columns, wanted, " ")
      for (i = 1; i <= count; ++i) printf "| %s ", text[wanted[i]]
      print "|"
    }'
}

head="world | controller | trace(P) | unseen | pose error | NEES/n"
{
  printf '\nEach controller by itself (%s trials each)\n\n| %s | log det P | path (dm) | verdict |\n' "$trials" "$head"
  echo '|---|---|---|---|---|---|---|---|---|'
  for i in "${!stems[@]}"; do
    for controller in $baselines; do row "${labels[i]}" "$controller" "${stems[i]}-baselines" "$controller.ekf"; done
    for criterion in $criteria; do row "${labels[i]}" "greedy, $criterion" "${stems[i]}-$criterion" greedy.ekf; done
  done
  printf '\nLess the planner by trace, trial by trial\n\n| %s |\n|---|---|---|---|---|---|\n' "$head"
  for i in "${!stems[@]}"; do
    stem=${stems[i]}
    for controller in $baselines; do difference "${labels[i]}" "$controller" "$stem" "$stem-baselines.h5" "$controller"; done
    for criterion in ${criteria#trace }; do
      difference "${labels[i]}" "greedy, $criterion" "$stem" "$stem-$criterion.h5" greedy
    done
  done
} | check_claims 20000
if [ -n "${PICTURE:-}" ]; then
  PYTHONPATH=python "${PYTHON:-python3}" experiments/planning/picture.py "$out" "$PICTURE"
fi
