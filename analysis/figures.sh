#!/usr/bin/env bash
# Makes docs/figures, or the folder named, by default figures/ where this is installed: the document's Figures 1 to 4
# from trial 0 of seed 1 (not a picked one), each beside the 10,000 trials that it is one of. Needs python3-h5py,
# python3-scipy and python3-matplotlib. The same program and matplotlib make the same bytes.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
if [ -d "$root/docs" ]; then
  built=$root/build/credence output=${1:-$root/docs/figures}
else  # installed: share/credence of a prefix
  built=$root/../../bin/credence output=${1:-figures}
fi
credence=${CREDENCE:-$built}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quiet=$([ -t 2 ] || echo --quiet)  # progress is for a terminal
"$credence" run "$root"/experiments/seed/kf-*.ini --trials 10000 --seed 1 $quiet -o "$work/seed.h5" >/dev/null
PYTHONPATH=$root/python${PYTHONPATH:+:$PYTHONPATH} "${PYTHON:-python3}" -m credence.pictures "$work/seed.h5" \
  --kind place --credence "$credence" -o "$work/pictures" >"$work/log"
mkdir -p "$output"
number=0
for scenario in kf-{straight,circle}-{constant,ranged}; do
  number=$((number + 1))
  cp "$work/pictures/$scenario-place.png" "$output/figure-$number.png"
done
