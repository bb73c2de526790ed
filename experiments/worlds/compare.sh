#!/usr/bin/env bash
# The tracker of experiments/own_filter beside what one would write instead, on one core of this machine: fixed-size
# Eigen, batched numpy, JAX and simdkalman, each with credence's NEES on credence's draws (compare/compare.py). Prints
# the processor and a table. PYTHON has numpy and h5py, and, if they are to be compared, jax and simdkalman.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/../own_filter/build.sh"
build_project "$here/../own_filter" own_filter
eigen=$(find /usr/include /usr/local/include -maxdepth 1 -name eigen3 | head -n 1)
for flags in "" " -march=native"; do
  "${CXX:-c++}" -std=c++20 -O3 -DNDEBUG $flags -isystem "$eigen" "$here/compare/loop.cpp" -o "build/loop${flags:+-native}"
done
echo "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1) (family $(sed -n 's/^cpu family.*: //p' /proc/cpuinfo | head -n 1))," \
  "$("${CXX:-c++}" --version | head -n 1), $(build/own_filter/tracker --version | head -n 1)"
echo
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 XLA_FLAGS=--xla_cpu_multi_thread_eigen=false
taskset -c 0 "${PYTHON:-python3}" "$here/compare/compare.py" build/own_filter/tracker "$here/../own_filter/tracker.ini" \
  "Eigen, fixed sizes, -O3=build/loop" "Eigen, fixed sizes, -O3 -march=native=build/loop-native"

# The world of 15 states beside its own version in doubles: the same header in a program without lanes.
build_project "$here" worlds
build_project "$here" worlds-doubles -DGALLERY_LANES=OFF
# seconds PROGRAM TRIALS: of processor time
seconds() {
  local TIMEFORMAT=%U
  { time taskset -c 0 "build/$1/gallery" run "$here/ins.ini" --trials "$2" --threads 1 --quiet --overwrite -o build/timed.h5; } 2>&1
}
lanes=$(seconds worlds 512) doubles=$(seconds worlds-doubles 128)
awk -v lanes="$lanes" -v doubles="$doubles" 'BEGIN {
  samples = 2 * 60 * 100  # of a trial, under two filters
  printf "\nins, a sample of the inertial unit: %.3g µs in lanes, %.3g µs one trial at a time, %.2g times as long\n",
    lanes / 512 / samples * 1e6, doubles / 128 / samples * 1e6, doubles / 128 / (lanes / 512)
}'
