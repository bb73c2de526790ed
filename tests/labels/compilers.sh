#!/usr/bin/env bash
# Label compilers: the core as compiled by clang at -O2 prints the committed digest. (That clang builds everything else
# without a warning, and that its program gives the bits of g++'s, is checked by the label sanitizers. `cmake --preset
# clang` builds program and tests, with loops over three features unrolled, which takes clang twice the time.)
set -euo pipefail
command -v clang++ >/dev/null || { echo "SKIPPED: clang++ is not installed"; exit 0; }
cmake --preset clang -DCREDENCE_WRITTEN_OUT=0 >/dev/null
cmake --build --preset clang --target credence_digest -j "$(nproc)" | tail -n 3
bash tests/digest/check.sh build-clang/tests/digest/credence_digest
