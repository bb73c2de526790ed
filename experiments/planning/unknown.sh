#!/usr/bin/env bash
# Does planning pay where the world must be discovered, and does it make the filter more optimistic? Open ground, rooms
# and corridors, a view of 90 and of 360 degrees, three heading noises: 20,000 trials each, or as many as --trials says;
# all arms of a cell share their draws. Writes results/planning/unknown-*.h5 and prints the tables of
# docs/planning.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/planning/tables.sh
trials=20000
if [ "${1:-}" = --trials ]; then trials=$2; fi
columns="pose_error coverage trace_P nees_ratio"
certain=3.9  # Bonferroni's bound for the 432 numbers of the second table
# What a new cell is worth: m² + rad² of the trace, nats of the log determinant.
declare -A worth=([trace]=0.01 [log_det]=1)

# diverged FILE.csv ARM: the share of trials in percent that failed or diverged.
diverged() {
  awk -F, -v arm="$2" '$2 == arm { printf "| %.2g ", 100 * $18 / $3; exit }' "$1"
}

# row CELL CONTROLLER STEM ARM: means, the share that failed or diverged, and the verdict.
row() {
  printf '| %s | %s %s %s| %s |\n' "$1" "$2" "$(means "$3.csv" "$4" $columns discovered)" "$(diverged "$3.csv" "$4")" \
    "$(verdict "$3.csv" "$4")"
}

# less CELL CRITERION STEM OTHER: the greedy planner less another controller, trial by trial.
less() {
  local files=("$3-$2.h5") column
  if [ "$4" != informed ]; then files+=("$3-baselines.h5"); fi
  "$credence" compare "${files[@]}" --arms "greedy,$4" --format csv >"$out/compared.csv"
  printf '| %s | %s | %s ' "$1" "$2" "$4"
  for column in $columns; do difference "$out/compared.csv" "$column"; done
  awk -F, '$4 == "nees_ratio" { printf "| %.2f | %.0f |\n", $15, 100 * $18; exit }' "$out/compared.csv"
}

for world in open rooms corridors; do
  for view in 90 360; do
    for sigma in 0.01 0.05 0.1; do
      stem=$out/unknown-$world-$view-$sigma
      settings=("sensor.view=$(awk -v view=$view 'BEGIN { printf "%.6f", view * 3.14159265 / 180 }')"
        "noise.heading=$sigma")
      study "$stem-baselines" "$trials" experiments/planning/$world.ini "arms.controllers=fixed, frontier" \
        "${settings[@]}"
      for criterion in trace log_det; do
        study "$stem-$criterion" "$trials" experiments/planning/$world.ini "arms.controllers=greedy, informed" \
          "${settings[@]}" "planner.criterion=$criterion" "planner.coverage=${worth[$criterion]}"
      done
      labels+=("$world | $view | $sigma") stems+=("$stem")
    done
  done
done

cell="world | view | σ_head"
{
  printf '\nEach controller by itself (%s trials each)\n\n' "$trials"
  echo "| $cell | controller | pose error | coverage | trace(P) | NEES/n | discovered | diverged, % | verdict |"
  echo '|---|---|---|---|---|---|---|---|---|---|---|'
  for i in "${!stems[@]}"; do
    for controller in fixed frontier; do
      row "${labels[i]}" $controller "${stems[i]}-baselines" $controller.ekf
    done
    for criterion in trace log_det; do
      for controller in greedy informed; do
        row "${labels[i]}" "$controller, $criterion" "${stems[i]}-$criterion" $controller.ekf
      done
    done
  done
  printf '\nGreedy less another controller, trial by trial (%s pairs each)\n\n' "$trials"
  echo "| $cell | criterion | less | pose error | coverage | trace(P) | NEES/n | its median | NEES/n higher, % |"
  echo '|---|---|---|---|---|---|---|---|---|---|---|'
  for i in "${!stems[@]}"; do
    for criterion in trace log_det; do
      for other in fixed frontier informed; do less "${labels[i]}" $criterion "${stems[i]}" $other; done
    done
  done
} | check_claims 1024  # those that docs/planning.md has
