#!/usr/bin/env bash
# Label compilers: the core prints the committed digest as compiled by clang at -O2, and by g++ at -O2 for aarch64, which
# is emulated; and the worlds of the gallery have the same bits from clang. (That clang builds everything else without a
# warning, and that its program gives the bits of g++'s, is checked by the label sanitizers. `cmake --preset clang` builds
# program and tests, with loops over three features unrolled, which takes clang twice the time.)
set -euo pipefail
for tool in clang++ aarch64-linux-gnu-g++ qemu-aarch64; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
cmake --preset clang -DCREDENCE_WRITTEN_OUT=0 >/dev/null
cmake --build --preset clang --target credence_digest -j "$(nproc)" | tail -n 3
bash tests/digest/check.sh build-clang/tests/digest/credence_digest
cmake --preset digest-aarch64 >/dev/null
cmake --build --preset digest-aarch64 --target credence_digest -j "$(nproc)" | tail -n 1
bash tests/digest/check.sh qemu-aarch64 build-digest-aarch64/tests/digest/credence_digest
bash tests/labels/gallery.sh c++ clang++
