#!/usr/bin/env bash
# A filter of one's own, from its source to a verdict: builds this folder on an installed credence as anybody's project
# would, runs the tracker and shows its report and what the two filters differ in. The first argument is the number of
# trials (10,000).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/build.sh"
build_project "$here" own_filter
tracker=build/own_filter/tracker results=results/tracker.h5
mkdir -p results
quiet=$([ -t 2 ] || echo --quiet)  # progress is for a terminal
$tracker run "$here/tracker.ini" --trials "${1:-10000}" $quiet --overwrite -o $results >/dev/null
$tracker report $results
$tracker compare $results --arms calm,kf
# Any credence reads the file. This is the check for a project's continuous integration:
"$prefix/bin/credence" report $results --require consistent >/dev/null || echo "exit code $?, as it should be"
