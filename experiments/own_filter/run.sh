#!/usr/bin/env bash
# A filter of one's own, from its source to a verdict: builds this folder on an installed credence as anybody's project
# would, runs the tracker and shows its report and what the two filters differ in. The first argument is the number of
# trials (10,000). In a checkout, credence is built and installed under build/installed first; where this folder was
# installed, it is that credence, and build/ and results/ are made in the folder that the script is called from.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
if [ -f "$here/../study.sh" ]; then
  cd "$here/../.."
  source experiments/study.sh
  build_program >&2
  cmake --install build --prefix build/installed >build/installed.log
  prefix=$PWD/build/installed
else
  prefix=$(cd "$here/../../../.." && pwd)
fi
project=build/own_filter results=results/tracker.h5
mkdir -p $project results
{ cmake -S "$here" -B $project -DCMAKE_PREFIX_PATH="$prefix" && cmake --build $project; } >$project.log 2>&1 ||
  { tail -n 30 $project.log; exit 1; }
$project/tracker run "$here/tracker.ini" --trials "${1:-10000}" --quiet --overwrite -o $results
$project/tracker report $results
$project/tracker compare $results --arms calm,kf
# Any credence reads the file. This is the check for a project's continuous integration:
"$prefix/bin/credence" report $results --require consistent >/dev/null || echo "exit code $?, as it should be"
