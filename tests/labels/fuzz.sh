#!/usr/bin/env bash
# Label fuzz: the fuzz targets build, their checksums are HDF5's own, and a few seconds of each find nothing new; more
# seconds each: FUZZ_SECONDS. Crashes within HDF5 do not count (see tests/fuzz/triage.sh).
set -euo pipefail
for tool in clang++ llvm-symbolizer; do
  command -v $tool >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
export FUZZ_JOBS=$(nproc)
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz -j "$FUZZ_JOBS" | tail -n 1
build-fuzz/tests/fuzz/fuzz_checksums tests/fuzz/seeds/*/*.h5 | { ! grep CHANGED; }
for target in scenario noise judge results journal; do
  bash tests/fuzz/run.sh $target "${FUZZ_SECONDS:-5}"
done
