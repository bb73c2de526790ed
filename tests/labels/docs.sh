#!/usr/bin/env bash
# Label docs: every output and table of README.md and docs that takes minutes to reproduce; the core tests check the
# others. The site is made without a warning; the claims of docs/theory/planning.md are as a second program finds them;
# the filters of other libraries get the verdicts that docs/in-the-wild.md explains, and the gallery's worlds those of
# docs/gallery.md.
set -euo pipefail
/usr/bin/python3 -c 'import h5py, scipy, matplotlib, PIL' 2>/dev/null ||
  { echo "SKIPPED: python3-h5py, python3-scipy, python3-matplotlib or python3-pil is not installed"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install build --prefix "$work/usr" >"$work/log" || { cat "$work/log"; exit 1; }
for project in own_filter worlds; do
  { cmake -S experiments/$project -B "$work/$project" -DCMAKE_PREFIX_PATH="$work/usr" && cmake --build "$work/$project"; } \
    >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
done
source tests/labels/package.sh
package_venv "$work"
export CREDENCE_PYTHON=$work/venv/bin/python
PYTHON=/usr/bin/python3 FURTHER_PROGRAMS="$work/own_filter/tracker $work/worlds/gallery" bash tests/docs/check.sh --slow "$@"
bash docs/build.sh >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
/usr/bin/python3 tests/planning_claims.py docs/theory/planning.md experiments/planning/criteria.csv
bash experiments/in_the_wild/run.sh --short >"$work/wild" || { cat "$work/wild"; exit 1; }
experiments=$PWD/experiments
(cd "$work" && GALLERY=worlds/gallery bash "$experiments/worlds/run.sh" >verdicts)
diff -u "$experiments/worlds/verdicts.txt" "$work/verdicts"
