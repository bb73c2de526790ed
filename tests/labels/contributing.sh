#!/usr/bin/env bash
# Label contributing: the diffs of CONTRIBUTING.md, applied one after the other to a copy of this tree, build, and each does
# what the page says. Its console blocks show what the program prints. With --apply: the diffs apply, and no more.
set -euo pipefail
for tool in git cmake c++; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build
mkdir "$tree" "$work/run"
git ls-files -z | xargs -0 cp --parents -t "$tree"
fail() { echo "CONTRIBUTING.md, $1" >&2; exit 1; }

# The diffs in their order, N-NAME.diff with the heading that each is below.
awk -v folder="$work" '
  /^```diff$/ { out = sprintf("%s/%d-%s.diff", folder, ++count, heading); next }
  /^```/ { out = "" }
  out != "" { print >out }
  out == "" && /^#/ { heading = $0; sub(/^#+ (An? )?/, "", heading); gsub(/[^A-Za-z]+/, "_", heading) }' CONTRIBUTING.md
checked="column statistic estimator world adapter report_format scenario_key"
found=$(cd "$work" && ls *.diff | sed -e 's/^[0-9]*-//' -e 's/\.diff$//' | xargs)
[ "$found" = "$checked" ] || fail "diffs: there are \"$found\", and this script checks \"$checked\""
for diff in "$work"/*.diff; do
  (cd "$tree" && git apply "$diff") || fail "$(basename "$diff"): does not apply"
done
if [ "${1:-}" = --apply ]; then exit; fi

# What is checked does not depend on the optimiser; so the cheapest build will do.
generator=() launcher=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi
if command -v ccache >/dev/null; then
  export CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
fi
{ cmake -S "$tree" -B "$build" "${generator[@]}" "${launcher[@]}" -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCREDENCE_TARGET_V4=OFF -DCREDENCE_WRITTEN_OUT=0 &&
  cmake --build "$build" --target credence tracker write_record -j "$(nproc)"; } >"$work/log" 2>&1 ||
  { tail -n 60 "$work/log"; fail "diffs: the tree does not build with them"; }
credence=$build/credence scenario=$tree/experiments/seed/ekf-circle-constant.ini
cd "$work/run"

# mean FILE ARM COLUMN: that column's mean in the report of a file.
mean() {
  "$credence" report "$1" --format csv |
    awk -F, -v arm="$2" -v column="$3" '$2 == arm && $5 == column { print $7; found = 1 } END { exit !found }' ||
    fail "$(basename "$1") has no column $3 of $2"
}
# run NAME OPTION...: a small study of the scenario, on the fixed path, in NAME.h5.
run() { "$credence" run "$scenario" --trials 300 --quiet --set arms.controllers=fixed -o "$1.h5" "${@:2}"; }
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > 0 && a < b) }'; }

# A column: of two poses the first has no error, so that the last one's is the sum; of twenty it is less.
run two --set scenario.poses=2
[ "$(mean two.h5 fixed.ekf last_pose_error)" = "$(mean two.h5 fixed.ekf pose_error)" ] || fail "A column: last_pose_error is wrong"
run twenty
below "$(mean twenty.h5 fixed.ekf last_pose_error)" "$(mean twenty.h5 fixed.ekf pose_error)" || fail "A column: last_pose_error is wrong"

# A statistic: it is the largest of the ratios by step.
"$credence" report twenty.h5 --format json | /usr/bin/python3 -c '
import json, sys
for group in json.load(sys.stdin)[0]["groups"]:
    assert group["largest_ratio"] == max(group["anees"]["ratio"]) > 0, group["group"]' || fail "A statistic: it is not the largest ratio"

# An estimator: it runs beside another one, and its covariance is larger.
run both --set arms.estimators=ekf,fading
below "$(mean both.h5 fixed.ekf mean_trace_P)" "$(mean both.h5 fixed.fading mean_trace_P)" || fail "An estimator: fading does not fade"

# A world: the filter that knows its model is consistent.
"$build/tests/tracker" run "$tree/experiments/own_filter/drift.ini" --trials 10000 --quiet -o drift.h5
"$credence" report drift.h5 --require consistent >drift || { cat drift; fail "A world: its filter is not consistent"; }

# An adapter: the shapes that judge takes, from objects with columns as FilterPy's.
/usr/bin/python3 - "$tree/python/credence/adapters/filterpy.py" <<'PY' || fail "An adapter: it does not give what judge takes"
import importlib.util, sys, types
import numpy as np
spec = importlib.util.spec_from_file_location("filterpy_adapter", sys.argv[1])
adapter = importlib.util.module_from_spec(spec)
spec.loader.exec_module(adapter)
saver = types.SimpleNamespace(x=np.ones((4, 2, 1)), P=[np.eye(2)] * 4, y=np.zeros((4, 1, 1)), S=[np.eye(1)] * 4)
given = adapter.from_filterpy([saver] * 3, np.zeros((3, 4, 2)))
shapes = {name: array.shape for name, array in given.items()}
assert shapes == {"error": (3, 4, 2), "covariance": (3, 4, 2, 2), "innovation": (3, 4, 1),
                  "innovation_covariance": (3, 4, 1, 1)}, shapes
assert (given["error"] == 1).all()
PY

# A report format: a table with the verdict of each arm, of results and of records.
"$credence" report both.h5 --format markdown >both.md
[ "$(wc -l <both.md)" -eq 4 ] && grep -qE '^\| ekf-circle-constant/fixed\.fading \| [a-z]+ \| [0-9.]+ ± [0-9.]+ \|' both.md ||
  { cat both.md; fail "A report format: it is not the table"; }
"$build/tests/write_record" record.h5
"$credence" judge record.h5 --quiet --format markdown | grep -E '^\| [A-Za-z_]+/record \| consistent \|' >/dev/null ||
  fail "A report format: judge does not give it"

# A scenario key: it is shown, takes effect, and is refused out of its range.
"$credence" show | grep -x 'filter.initial = 1' >/dev/null || fail "A scenario key: it is not shown"
run told --set noise.initial_position=1
run mistold --set noise.initial_position=1 --set filter.initial=0.5
below "$(mean told.h5 fixed.ekf nees_ratio)" "$(mean mistold.h5 fixed.ekf nees_ratio)" || fail "A scenario key: it has no effect"
status=0
run refused --set filter.initial=0 2>refusal || status=$?
[ $status -eq 2 ] && grep -q 'invalid filter.initial=0 (' refusal || { cat refusal; fail "A scenario key: 0 is not refused"; }

cd "$tree"
CREDENCE=$credence bash tests/docs/check.sh CONTRIBUTING.md
echo "seven diffs apply, build and do what CONTRIBUTING.md says"
