#!/usr/bin/env bash
# Label sanitizers: tests of everything that handles memory, and the fuzz targets, under clang's address and
# undefined-behaviour sanitizers, warnings as errors. All tests but those marked [long]: `cmake --preset sanitizers`.
# Of the fuzz targets: their checksums are HDF5's own, and a few seconds of each find nothing new (more: FUZZ_SECONDS).
# Crashes within HDF5 do not count (tests/fuzz/triage.sh).
set -euo pipefail
for tool in clang++ llvm-symbolizer; do
  command -v $tool >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
export FUZZ_JOBS=$(nproc)
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz -j "$FUZZ_JOBS" | tail -n 3
(
  export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
  export LSAN_OPTIONS=suppressions=$PWD/tests/labels/leaks.supp:print_suppressions=0
  log=build-fuzz/tests.log
  ctest --test-dir build-fuzz -L core -j "$FUZZ_JOBS" --output-on-failure >$log 2>&1 || { tail -n 100 $log; exit 1; }
  grep 'tests passed' $log
)
build-fuzz/tests/fuzz/fuzz_checksums tests/fuzz/seeds/*/*.h5 | { ! grep CHANGED; }
for target in scenario noise judge results journal; do
  bash tests/fuzz/run.sh $target "${FUZZ_SECONDS:-4}"
done
