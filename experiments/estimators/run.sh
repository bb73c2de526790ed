#!/usr/bin/env bash
# Which estimator's covariance can be believed in the document's world, matched to the filter? Heading noise from 0.001
# to 0.1, straight and circle, five estimators on the same draws; 100,000 trials each (some minutes on 2 cores), or as
# many as the first argument says. Writes results/estimators/*.h5 and prints the tables of docs/theory/estimators.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
trials=${1:-100000}
out=results/estimators arms="ekf ideal fej riekf iekf"

# row PATH POSES SIGMA FIGURE...: a study, unless it exists already, and a row with each arm's values.
row() {
  local path=$1 poses=$2 sigma=$3 name=$1-$2-$3 arm figure cell
  shift 3
  study "$out/$name" "$trials" experiments/consistency/matched-ekf.ini "features.path=$path" "scenario.poses=$poses" \
    "noise.heading=$sigma" "arms.estimators=${arms// /, }"
  printf '| %s %s | %s ' "$path" "$poses" "$sigma"
  for arm in $arms; do
    cell=
    for figure in "$@"; do cell="$cell${cell:+; }$(interval "$out/$name.csv" "fixed.$arm" "$figure")"; done
    printf '| %s ' "$cell"
  done
  printf '|\n'
}

# table TITLE FIGURE...
table() {
  printf '\n%s\n\n| path, poses | σ_head | %s |\n|---|---|---|---|---|---|---|\n' "$1" "${arms// / | }"
  shift
  local sigma
  for sigma in 0.001 0.01 0.03 0.05 0.1; do row straight 20 "$sigma" "$@"; done
  for sigma in 0.01 0.03 0.05; do row circle 100 "$sigma" "$@"; done
}

table "NEES/dim of the whole state; of the pose ($trials trials each, 95 %)" nees_per_dimension:all nees_per_dimension:pose
table "The same with the error in the invariant chart" nees_per_dimension_invariant:all nees_per_dimension_invariant:pose
table "Pose: squared error summed over all poses" pose_error
