#!/usr/bin/env bash
# Label compilers: what clang makes of the core at -O2 prints the committed digest. (That it builds all of the rest
# without a warning, and that its program gives the bits of g++'s, the label sanitizers shows. `cmake --preset clang`
# builds program and tests, and writes three features out, which takes clang twice the time.)
set -euo pipefail
command -v clang++ >/dev/null || { echo "SKIPPED: clang++ is not installed"; exit 0; }
cmake --preset clang -DCREDENCE_WRITTEN_OUT=0 >/dev/null
cmake --build --preset clang --target credence_digest -j "$(nproc)" | tail -n 3
bash tests/digest/check.sh build-clang/tests/digest/credence_digest
