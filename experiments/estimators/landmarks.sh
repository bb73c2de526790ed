#!/usr/bin/env bash
# Which estimators stay consistent among landmarks on a loop? Five estimators on the same 4,000 trials (a minute or two
# on 2 cores), or as many as the first argument says, and three other heading noises. Writes
# results/estimators/landmarks*.h5 and docs/figures/landmarks*.png, and prints the tables of docs/theory/estimators.md.
# Needs python3-h5py, python3-scipy, python3-matplotlib and python3-pil.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
trials=${1:-4000}
out=results/estimators here=experiments/estimators/landmarks.ini
study "$out/landmarks" "$trials" "$here"
sweep=()
for sigma in 0.001 0.01 0.02; do
  study "$out/landmarks-$sigma" "$trials" "$here" "noise.heading=$sigma" "arms.estimators=ekf, riekf"
  sweep+=("$sigma=$out/landmarks-$sigma.h5")
done
PYTHONPATH=python${PYTHONPATH:+:$PYTHONPATH} "${PYTHON:-python3}" experiments/estimators/landmarks.py "$out/landmarks.h5" \
  -o docs/figures --sweep "${sweep[@]}"
