#!/usr/bin/env bash
# The study of docs/polygon.md, in a checkout: the world `polygon` as published and mended, with constant and ranged
# noise, 1,000 trials each or as many as the first argument says; and on its paths some flaws mended by themselves.
# Prints polygon.csv, means with 95 % intervals. GALLERY is the program, where it is built already.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
if [ -z "${GALLERY:-}" ]; then
  source "$here/../own_filter/build.sh"
  build_project "$here" worlds >&2
  GALLERY=build/worlds/gallery
fi
cd "$here/../.."
CREDENCE=$GALLERY
source experiments/study.sh
trials=${1:-1000}
columns="trace_P mean_trace_P unseen position_error rotation_error feature_error nees_ratio nees_per_dimension:pose
  nees_per_dimension:features clearance rolled"

# rows LABEL STEM ARM...: a line of each arm.
rows() {
  local label=$1 stem=$2 arm column
  shift 2
  for arm in "$@"; do
    printf '%s,%s' "$label" "$arm"
    for column in $columns; do printf ',%s' "$(interval "$stem.csv" "$arm" "$column")"; done
    printf ',%s\n' "$(verdict "$stem.csv" "$arm")"
  done
}

echo "setting,arm,trace(P),its mean,unseen,position (cm),rotation (rad),features (cm),NEES/n,NEES/n of the pose,NEES/n of the features,clearance (cm),rolled,verdict"
out=results/polygon ini=experiments/worlds/polygon.ini
for noise in constant ranged; do
  for variant in published mended; do
    study "$out/$noise-$variant" "$trials" $ini "model.variant=$variant" "sensor.noise=$noise"
    rows "$noise; $variant" "$out/$noise-$variant" fixed return greedy global combined
  done
done
for flaw in jacobian breath tails edges; do
  study "$out/$flaw" "$trials" $ini model.variant=published "flaw.$flaw=mended" arms.which=paths
  rows "constant; $flaw mended" "$out/$flaw" fixed return
done
