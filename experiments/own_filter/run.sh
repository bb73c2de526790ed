#!/usr/bin/env bash
# A filter of one's own, from its source to a verdict: installs credence under build/installed, builds this folder on it
# as anybody's project would, runs the tracker and shows its report and what the two filters differ in. The first argument
# is the number of trials (10,000).
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
cmake --install build --prefix build/installed >build/installed.log
cd experiments/own_filter
project=../../build/own_filter
{ cmake -S . -B $project -DCMAKE_PREFIX_PATH="$PWD/../../build/installed" && cmake --build $project; } >$project.log 2>&1 ||
  { tail -n 30 $project.log; exit 1; }
results=../../results
mkdir -p $results
$project/tracker run tracker.ini --trials "${1:-10000}" --quiet --overwrite -o $results/tracker.h5
$project/tracker report $results/tracker.h5
$project/tracker compare $results/tracker.h5 --arms calm,kf
# Any credence reads the file. What somebody's CI would ask:
../../build/credence report $results/tracker.h5 --require consistent >/dev/null || echo "exit code $?, as it should be"
