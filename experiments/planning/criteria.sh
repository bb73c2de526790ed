#!/usr/bin/env bash
# Which criterion buys what? The planner by each of its criteria, and the controllers that do not plan, in the document's
# world, in the matched one, and with more heading noise: 20,000 trials each, or as many as the first argument says; all
# share their draws. Writes results/planning/criteria-*.h5 and prints the tables of docs/planning.md.
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

# row WORLD CONTROLLER FILE.csv ARM: the means of an arm, and its verdict.
row() {
  local column
  printf '| %s | %s ' "$1" "$2"
  for column in $columns; do printf '| %s ' "$(interval "$3" "$4" "$column")"; done
  printf '| %s |\n' "$(verdict "$3" "$4")"
}

# difference WORLD CONTROLLER STEM FILE.h5 ARM: the arm less the planner by trace, by trial with 95 % intervals.
# Differences that are certain are bold: beyond 3.7 standard errors, which is Bonferroni's bound for the 5 worlds,
# 9 controllers and 4 columns of these tables together (0.05/180, two-sided).
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
printf '\nEach controller by itself (%s trials each)\n\n| %s | verdict |\n|---|---|---|---|---|---|---|\n' "$trials" "$head"
for i in "${!stems[@]}"; do
  for controller in $baselines; do row "${labels[i]}" "$controller" "${stems[i]}-baselines.csv" "$controller.ekf"; done
  for criterion in $criteria; do row "${labels[i]}" "greedy, $criterion" "${stems[i]}-$criterion.csv" greedy.ekf; done
done
printf '\nLess the planner by trace, trial by trial\n\n| %s |\n|---|---|---|---|---|---|\n' "$head"
for i in "${!stems[@]}"; do
  stem=${stems[i]}
  for controller in $baselines; do difference "${labels[i]}" "$controller" "$stem" "$stem-baselines.h5" "$controller"; done
  for criterion in ${criteria#trace }; do
    difference "${labels[i]}" "greedy, $criterion" "$stem" "$stem-$criterion.h5" greedy
  done
done
