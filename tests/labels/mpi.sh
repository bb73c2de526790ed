#!/usr/bin/env bash
# Label mpi: the core's program with MPI (one file more), under mpirun.
set -euo pipefail
for tool in mpirun mpicc h5diff; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
if build/credence --version | grep -q 'MPI none'; then
  cmake -S . -B build -DCREDENCE_MPI=ON >/dev/null
  cmake --build build --target credence -j "$(nproc)" | tail -n 1
fi
bash tests/cluster/mpi.sh build/credence
