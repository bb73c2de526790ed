#!/usr/bin/env bash
# Which estimator keeps a heading that nothing observes? World G: 100 steps on the circle, features that walk but do not
# drift, no edges; five estimators on the same 2,000 trials, or as many as the first argument says (seconds). Writes
# results/estimators/world-g.h5 and prints the tables of docs/theory/estimators.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
trials=${1:-2000}
file=results/estimators/world-g arms="ekf ideal fej riekf iekf"
study "$file" "$trials" experiments/estimators/world-g.ini

# table TITLE FIGURE: NEES/dim of every arm at some steps, and over all of them.
table() {
  printf '\n%s\n\n| step | %s |\n|---|---|---|---|---|---|\n' "$1" "${arms// / | }"
  local step arm figure
  for step in 20 40 60 80 100 all; do
    figure=$2:$step
    if [ "$step" = all ]; then figure=$2; fi
    printf '| %s ' "$step"
    for arm in $arms; do printf '| %s ' "$(interval "$file.csv" "fixed.$arm" "$figure")"; done
    printf '|\n'
  done
}

table "NEES of the heading ($trials trials, 95 %)" nees_per_dimension:heading
table "NEES/dim of the pose" nees_per_dimension:pose
table "NEES/dim of the whole state" nees_per_dimension:all
table "NEES/dim of the whole state, error in the invariant chart" nees_per_dimension_invariant:all
