#!/usr/bin/env bash
# Label digest: the core prints the committed digest in lanes of any width at -O1, and from the core's own build on older
# x86 processors, emulated. The core label has g++ at -O3, the label compilers clang at -O2 and g++ on aarch64. (g++ at
# -O2 on this processor: `cmake --preset digest-o2`.)
set -euo pipefail
command -v qemu-x86_64 >/dev/null || { echo "SKIPPED: qemu-x86_64 is not installed"; exit 0; }

native=build/tests/digest/credence_digest
checks=()
cmake --build build --target credence_digest_widths -j "$(nproc)" | tail -n 1
bash tests/digest/check.sh build/tests/digest/credence_digest_widths

# A processor of 2006 has neither AVX nor fma: an instruction too new would end the program. One of 2013 has no AVX-512.
if [ "$(uname -m)" = x86_64 ]; then
  bash tests/digest/check.sh qemu-x86_64 -cpu core2duo $native portable &
  checks+=($!)
  bash tests/digest/check.sh qemu-x86_64 -cpu Haswell $native v3
  for beyond in 'core2duo v3' 'core2duo v4' 'Haswell v4'; do
    read -r processor unit <<<"$beyond"
    status=0
    qemu-x86_64 -cpu "$processor" $native "$unit" >/dev/null 2>&1 || status=$?
    [ $status -eq 2 ] || { echo "unit $unit is not refused on $processor"; exit 1; }
  done
fi
for check in "${checks[@]}"; do wait "$check"; done
