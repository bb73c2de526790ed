#!/usr/bin/env bash
# The gallery: builds the program of this folder on an installed credence, runs each world's study and prints its
# verdicts: results/NAME.h5. The first argument is the number of trials (4,000). With PICTURES=FOLDER it also draws
# there the pictures of docs/gallery.md, NAME.png (needs python3-h5py, python3-scipy and python3-matplotlib).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/../own_filter/build.sh"
build_project "$here" worlds
mkdir -p results
for scenario in "$here"/*.ini; do
  name=$(basename "$scenario" .ini)
  build/worlds/gallery run "$scenario" --trials "${1:-4000}" --quiet --overwrite -o "results/$name.h5"
  build/worlds/gallery report "results/$name.h5" | awk -v RS= '/verdict +NEES/ { print $0 "\n" }'
  [ -n "${PICTURES:-}" ] || continue
  PYTHONPATH=$here/../../python "${PYTHON:-python3}" -m credence.pictures "results/$name.h5" --kind nees -o build/pictures
  mkdir -p "$PICTURES"
  cp "build/pictures/$name-nees.png" "$PICTURES/$name.png"
done
