#!/usr/bin/env bash
# Label gallery: the worlds of experiments/worlds, built on an installed credence, give the same bits in every target that
# this machine runs, for any number of threads, by each compiler that is an argument (the label compilers calls it with
# c++ and clang++). Without one it is clang++, which takes half as long as g++. The label docs runs their studies, by c++.
set -euo pipefail
command -v h5diff >/dev/null || { echo "SKIPPED: h5diff is not installed"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install build --prefix "$work/usr" >"$work/log"
compilers=("$@")
if [ $# -eq 0 ]; then
  compilers=(c++)
  if command -v clang++ >/dev/null; then compilers=(clang++); fi
fi
for compiler in "${compilers[@]}"; do
  # (The bits are the same at any level of optimisation, and -O1 takes half as long to compile.)
  { cmake -S experiments/worlds -B "$work/$compiler" -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_CXX_COMPILER="$compiler" \
      -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" &&
    cmake --build "$work/$compiler" -j "$(nproc)"; } >"$work/log" 2>&1 || { tail -n 40 "$work/log"; exit 1; }
done
compared=0
for scenario in experiments/worlds/*.ini; do
  # run NAME COMPILER THREADS: its file, without what says when and how it was made.
  run() {
    "$work/$2/gallery" run "$scenario" --trials 20 --set scenario.poses=12 --threads "$3" --quiet --overwrite -o "$work/$1.h5"
  }
  CREDENCE_FORCE_TARGET=portable run expected "${compilers[0]}" 1
  for compiler in "${compilers[@]}"; do
    # (Those that credence was built for.)
    for target in $(ls "$work/$compiler"/gallery_*.o | sed 's|.*/gallery_\(.*\)\.o|\1|'); do
      CREDENCE_FORCE_TARGET=$target run other "$compiler" 3 2>"$work/refused" ||
        { grep -q 'cannot run it' "$work/refused" || { cat "$work/refused"; exit 1; }; continue; }
      h5diff --exclude-path /run "$work/expected.h5" "$work/other.h5" ||
        { echo "$scenario: $compiler and $target give other bits than ${compilers[0]} and portable"; exit 1; }
      compared=$((compared + 1))
    done
  done
done
[ $compared -ge $((5 * ${#compilers[@]})) ] || { echo "only $compared files were compared"; exit 1; }
echo "$compared files of the gallery have the same bits"
