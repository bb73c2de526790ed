#!/usr/bin/env bash
# The gallery: builds the program of this folder on an installed credence, runs each world's study and prints its
# verdicts: results/NAME.h5. The first argument is the number of trials (4,000). With PICTURES=FOLDER it also draws
# there the pictures of docs/gallery.md, NAME.png (needs python3-h5py, python3-scipy and python3-matplotlib). GALLERY is
# the program, where it is built already. In a checkout it checks what docs/gallery.md says of 4,000 trials, and of two
# studies more.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
if [ -z "${GALLERY:-}" ]; then
  source "$here/../own_filter/build.sh"
  build_project "$here" worlds
  GALLERY=build/worlds/gallery
fi
mkdir -p results
quiet=$([ -t 2 ] || echo --quiet)  # progress is for a terminal
worlds=$(basename -s .ini "$here"/*.ini | grep -v polygon)  # whose study is polygon.sh
for name in $worlds; do
  "$GALLERY" run "$here/$name.ini" --trials "${1:-4000}" $quiet --overwrite -o "results/$name.h5" >/dev/null
  "$GALLERY" report "results/$name.h5" | awk -v RS= '/verdict +NEES/ { print $0 "\n" }'
  [ -n "${PICTURES:-}" ] || continue
  PYTHONPATH=$here/../../python "${PYTHON:-python3}" -m credence.pictures "results/$name.h5" --kind nees --overwrite -o build/pictures
  mkdir -p "$PICTURES"
  cp "build/pictures/$name-nees.png" "$PICTURES/$name.png"
done
if [ "${1:-4000}" -eq 4000 ] && [ -f "$here/../claims.py" ]; then
  "$GALLERY" run "$here/coordinated_turn.ini" --set scenario.name=long --trials 200000 $quiet --overwrite \
    -o results/long.h5 >/dev/null
  "$GALLERY" run "$here/attitude.ini" --set scenario.name=sure --set start.attitude=0.1 --trials 4000 $quiet \
    --overwrite -o results/sure.h5 >/dev/null
  reports=()
  for file in long sure $worlds; do
    "$GALLERY" report "results/$file.h5" --format csv >"results/$file.csv"
    reports+=("results/$file.csv")
  done
  "${PYTHON:-python3}" "$here/../claims.py" "$here/claims.py" "${reports[@]}" "$here/../../docs/gallery.md"
fi
