#!/usr/bin/env bash
# Label compilers: clang builds the program without a warning, prints the committed digest, and its program gives the bits
# of g++'s. (`cmake --preset clang` builds the tests as well.)
set -euo pipefail
cmake --preset clang >/dev/null
cmake --build --preset clang --target credence credence_digest -j "$(nproc)" | tail -n 3
bash tests/digest/check.sh build-clang/tests/digest/credence_digest
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for compiler in build build-clang; do
  "$compiler/credence" run experiments/seed/*.ini --trials 600 --quiet -o "$work/$compiler.h5"
done
h5diff --exclude-path /run "$work/build.h5" "$work/build-clang.h5"
echo "g++ and clang: the same bits in 8 scenarios"
