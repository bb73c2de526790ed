#!/usr/bin/env bash
# A planner of one's own in C++, beside the built-in ones in the rooms of experiments/explore: builds this folder on an
# installed credence as anybody's project would, runs the study and shows what the planners differ in. The first argument
# is the number of trials (1,000).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/../own_filter/build.sh"
build_project "$here" planner
mkdir -p results
quiet=$([ -t 2 ] || echo --quiet)  # progress is for a terminal
build/planner/curious run "$here/../explore/rooms.ini" --set arms.controllers=fixed,frontier,greedy \
  --set arms.planners=curious --trials "${1:-1000}" $quiet --overwrite -o results/curious.h5 >/dev/null
"$prefix/bin/credence" compare results/curious.h5 --arms curious.ekf,greedy.ekf  # any credence reads the file
