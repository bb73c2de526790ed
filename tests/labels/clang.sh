#!/usr/bin/env bash
# Label clang: clang takes the whole product without an error or a warning, after tests/run.sh. The label sanitizers, which
# compiles and runs it, takes too long for CI.
set -euo pipefail
command -v clang++ >/dev/null || { echo "SKIPPED: clang++ is not installed"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=(-std=c++20 -fopenmp -Wall -Wextra -Wconversion -Werror -Isrc -Iinclude -Ibuild/generated
  -isystem /usr/include/eigen3 -isystem /usr/include/hdf5/serial -DEIGEN_DONT_PARALLELIZE -DCREDENCE_WRITTEN_OUT=0)
clang++ "${flags[@]}" -x c++-header src/precompiled.hpp -o "$work/pch"
ls build/src/CMakeFiles/*/Unity/*.cxx | xargs -P "$(nproc)" -n 1 clang++ "${flags[@]}" -include-pch "$work/pch" -fsyntax-only
