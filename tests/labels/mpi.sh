#!/usr/bin/env bash
# Label mpi: the processes of Open MPI's mpirun as shards, also after one of them was killed.
set -euo pipefail
for tool in mpirun h5diff; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: $tool is not installed"; exit 0; }
done
credence=$PWD/build/credence
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp tests/durability/tiny.ini "$work"
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
study=(run tiny.ini --trials 2000000 --keep aggregates --quiet --threads 1)
shards=(mpirun --quiet -n 3 "$credence" "${study[@]}" --shard auto -o 'part-{shard}.h5')

"$credence" "${study[@]}" -o one.h5
"${shards[@]}" &
job=$!
until [ -s part-1.h5.journal ]; do
  kill -0 $job || { echo "the job ended before it had begun"; exit 1; }
  sleep 0.01
done
for process in $(pgrep -P $job); do
  if grep -qz '^OMPI_COMM_WORLD_RANK=1$' "/proc/$process/environ"; then kill -KILL "$process"; fi
done
if wait $job; then echo "a process was killed, and mpirun says that all went well"; exit 1; fi
if "$credence" merge part-*.h5 -o merged.h5 2>said || ! [ -e part-1.h5.journal ]; then
  echo "the shards were complete before one could be killed: $(cat said)"
  exit 1
fi
"${shards[@]}" --resume
"$credence" merge part-*.h5 -o merged.h5 --quiet
h5diff --exclude-path /run one.h5 merged.h5
echo "3 processes of mpirun, one of them killed and resumed: the results of one run"
