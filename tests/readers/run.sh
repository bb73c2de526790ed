#!/usr/bin/env bash
# run.sh CREDENCE: a results file and a trajectory file read by everything that opens them, each against the JSON of the
# program, and the pure part of the Python package with its pictures. Says SKIPPED for a reader that is not installed.
set -euo pipefail
credence=$1
readers=tests/readers
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
has() { command -v "$1" >/dev/null || { echo "SKIPPED: $1 is not installed"; return 1; }; }

"$credence" run experiments/seed/kf-circle-constant.ini experiments/seed/ekf-circle-ranged.ini --trials 600 --seed 1 \
  --quiet -o "$work/study.h5"
"$credence" report "$work/study.h5" --format json >"$work/report.json"
"$credence" replay "$work/study.h5" --scenario ekf-circle-ranged --arm greedy.ekf --trial 17 --format json \
  -o "$work/trace.h5" >"$work/replay.json"
/usr/bin/python3 $readers/expected.py "$work/report.json" "$work/replay.json" "$work/expected.tsv"
# A world of one's own.
cmake --build build --target tracker >"$work/tracker.log" 2>&1 || { tail -n 30 "$work/tracker.log"; exit 1; }
build/tests/tracker run experiments/own_filter/tracker.ini --trials 300 --quiet -o "$work/own.h5"
mkdir "$work/pictures"
files=("$work/study.h5" "$work/trace.h5" "$work/expected.tsv")

# Octave says the same harmless error on its way out, whatever the netcdf package was asked for.
octave_run() { octave-cli --quiet "$@" 2>"$work/octave.err" || { cat "$work/octave.err"; return 1; }; }
with_octave() {
  octave_run $readers/readers.m "${files[@]}"
  octave_run $readers/functions.m "$work/study.h5" kf-circle-constant "$work/pictures/octave.svg" >"$work/pictures/octave.tsv"
}
others=()
if has octave-cli && has gnuplot; then with_octave & others+=($!); fi
with_r() {
  Rscript $readers/readers.R "${files[@]}"
  Rscript $readers/functions.R "$work/study.h5" >"$work/pictures/r.tsv"
}
if has Rscript; then with_r & others+=($!); fi
for reader in h5py netcdf4 xarray-netcdf4 xarray-h5netcdf h5dump ncdump; do
  /usr/bin/python3 $readers/readers.py $reader "${files[@]}"
done
for other in "${others[@]}"; do wait "$other"; done

if /usr/bin/python3 -c 'import h5py, scipy, matplotlib, pytest' 2>/dev/null; then
  export CREDENCE=$PWD/$credence PYTHONDONTWRITEBYTECODE=1
  # Of the pictures each kind, with few arms and many: another matplotlib draws them here than in the label python, which
  # has all tests.
  PYTHONPATH=python /usr/bin/python3 -m pytest -q -p no:cacheprovider python/tests/test_study.py \
    python/tests/test_pictures.py -k 'not test_pictures or any_number_of_arms or draws_all or trial_moves' \
    >"$work/pytest.log" || { cat "$work/pytest.log"; exit 1; }
  tail -n 1 "$work/pytest.log"
  /usr/bin/python3 $readers/analysis_test.py "$work/study.h5" "$work/own.h5" "$work/pictures" | tail -n 1
  unset CREDENCE
  cmake --install build --prefix "$work/usr" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
  (cd "$work" && PYTHON=/usr/bin/python3 bash usr/share/credence/analysis/figures.sh) >"$work/figures.log" 2>&1 &&
    [ -s "$work/figures/figure-4.png" ] || { cat "$work/figures.log"; exit 1; }
else
  echo "SKIPPED: python3-matplotlib or python3-pytest is not installed"
fi
