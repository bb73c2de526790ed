#!/usr/bin/env bash
# Label sanitizers: tests of everything that reads files from elsewhere, and the fuzz targets, under clang's address and
# undefined-behaviour sanitizers, warnings as errors. All tests: `cmake --preset sanitizers`.
# The program gives the bits of g++'s. Of the fuzz targets: their checksums are HDF5's own, and the kept inputs pass.
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
  # One test takes most of a minute here, and seconds without sanitizers.
  ctest --test-dir build-fuzz -L core -E 'totals in a journal that no trials could give' -j "$FUZZ_JOBS" \
    --output-on-failure >$log 2>&1 || { tail -n 100 $log; exit 1; }
  grep 'tests passed' $log
)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for compiler in build build-fuzz; do
  ASAN_OPTIONS=detect_leaks=0 "$compiler/credence" run experiments/seed/*.ini --trials 40 --quiet -o "$work/$compiler.h5"
done
h5diff --exclude-path /run "$work/build.h5" "$work/build-fuzz.h5"
echo "g++ and clang: the same bits in 8 scenarios"
build-fuzz/tests/fuzz/fuzz_checksums tests/fuzz/seeds/*/*.h5 | { ! grep CHANGED; }
# Seeds that the program no longer accepts would be useless for a target.
for seed in tests/fuzz/seeds/results/*.h5; do
  build/credence report "$seed" >/dev/null
  build/credence merge "$seed" -o "$work/merged.h5" --overwrite --quiet
done
for seed in tests/fuzz/seeds/journal/*; do
  cp "$seed" "$work/seed.h5.journal"
  build/credence watch "$work/seed.h5" --once >/dev/null
done
# The kept inputs must pass. New findings of a few seconds are shown for a person to examine: chance must not fail a
# build.
for target in scenario noise judge arrays results journal; do
  folders=()
  for folder in tests/fuzz/{seeds,found}/$target; do [ ! -d "$folder" ] || folders+=("$folder"); done
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=1024 OMP_NUM_THREADS=1 \
    "build-fuzz/tests/fuzz/fuzz_$target" -runs=0 -rss_limit_mb=2048 "${folders[@]}" >build-fuzz/kept.log 2>&1 ||
    { tail -n 50 build-fuzz/kept.log; exit 1; }
  bash tests/fuzz/run.sh $target "${FUZZ_SECONDS:-1}" || echo "$target: look at these findings"
done
