#!/usr/bin/env bash
# The scripts of experiments/cluster on a real Slurm of one node: an array of 8 tasks, of which one is told that its
# time is over, one is put back into the queue by hand and one is killed; then everything is submitted again. The merged
# results are those of one run. And srun's processes as shards.
# usage: slurm.sh [CREDENCE]   as root, on a machine or container of its own (Debian 12: it installs slurm-wlm and
# munge, and starts their daemons where none run); without CREDENCE it builds build/credence. About five minutes: Slurm
# waits two before it starts a task again.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
install_missing slurm-wlm munge hdf5-tools
if [ $# -eq 0 ]; then
  install_missing $build_packages
  build build credence -DCMAKE_BUILD_TYPE=Release -DCREDENCE_TESTS=OFF
fi
export CREDENCE
CREDENCE=$(realpath "${1:-build/credence}")
"$CREDENCE" --version >/dev/null
sinfo >/dev/null 2>&1 || bash tests/slurm/one_node_slurm.sh

export OUTPUT=results/slurm-test/study.h5 STUDY=results/slurm-test/both.ini TRIALS=2000000 SEED=7 SHARDS=8
rm -rf results/slurm-test
mkdir -p results/slurm-test
cat >$STUDY <<'INI'
[scenario]
name = both
poses = 30
INI

fail() {
  echo "FAILED: $*" >&2
  squeue >&2 || true
  tail -n 5 credence-*.log >&2 || true
  exit 1
}
state() { squeue -h -j "$1" -o %T 2>/dev/null || true; }
until_is() {  # until_is WHAT COMMAND...: waits until the command succeeds, five minutes at most
  local what=$1
  shift
  for _ in $(seq 1500); do
    if "$@"; then return; fi
    sleep 0.2
  done
  fail "waited for $what"
}
gone() { [ -z "$(state "$1")" ]; }
# In the middle of its work: some of it is committed.
works() {
  [ "$(stat -c %s "$OUTPUT.parts/part-$2.h5.journal" 2>/dev/null || echo 0)" -gt 200000 ] && [ "$(state "$1_$2")" = RUNNING ]
}
program_of() {  # the process of credence in a task
  local process
  for process in /proc/[0-9]*; do
    if [ "$(cat "$process/comm" 2>/dev/null)" = "$(basename "$CREDENCE")" ] &&
      tr '\0' '\n' <"$process/environ" 2>/dev/null | grep -qx "SLURM_ARRAY_JOB_ID=$1" &&
      tr '\0' '\n' <"$process/environ" 2>/dev/null | grep -qx "SLURM_ARRAY_TASK_ID=$2"; then
      echo "${process#/proc/}"
      return
    fi
  done
  fail "task $2 has no process"
}
submitted() {
  local said
  said=$(bash experiments/cluster/submit.sh)
  read -r array merge < <(sed -n 's/^array \([0-9]*\), then merge \([0-9]*\) .*/\1 \2/p' <<<"$said")
  [ -n "$merge" ] || fail "submit.sh said: $said"
}

submitted
until_is "task 0" works "$array" 0
# What --signal=B:TERM@60 does a minute before the limit. scancel goes on trying when the task is in the queue again.
scancel --signal=TERM --batch "${array}_0" >/dev/null 2>&1 &
until_is "task 1" works "$array" 1
until_is "task 1 to be put back" scontrol requeue "${array}_1"  # as when its node fails
until_is "task 2" works "$array" 2
kill -KILL "$(program_of "$array" 2)"
until_is "the array's end" gone "$array"
until_is "the merge's end" gone "$merge"
grep -q "task 0: credence ended with 3" "credence-${array}_0.log" || fail "task 0 did not end with 3"
grep -q "task 0: credence ended with 0 after 1 restarts" "credence-${array}_0.log" || fail "task 0 did not go on"
grep -q "task 1: credence ended with 0 after 1 restarts" "credence-${array}_1.log" || fail "task 1 did not go on"
grep -q "task 2: credence ended with 137" "credence-${array}_2.log" || fail "task 2 was not killed"
grep -q "scenario both lacks blocks 2, 10, 18" "credence-$merge-merge.log" || fail "the merge did not name what is missing"
[ ! -e $OUTPUT ] || fail "the merge wrote a file though blocks are missing"
echo "array: a task stopped in time and one put back went on by themselves; the merge named what the killed one lacks"

# The limit itself: two minutes, and the signal 100 s before (Slurm may send it up to a minute earlier).
limited=$(TRIALS=1e9 OUTPUT=results/slurm-test/limited.h5 sbatch --parsable --array=5-5 --time=2 --signal=B:TERM@100 \
  experiments/cluster/array.sh)
until_is "the signal before the limit" grep -qs "task 5: credence ended with 3 after 0 restarts" "credence-${limited}_5.log"
pending() { [ "$(state "$1")" = PENDING ]; }
until_is "the task in the queue again" pending "$limited"
scancel "$limited"
echo "time limit: the task stopped before it and went back into the queue"

submitted
until_is "the second array's end" gone "$array"
until_is "the second merge's end" gone "$merge"
[ -e $OUTPUT ] || fail "the merge wrote nothing"
"$CREDENCE" run $STUDY --trials $TRIALS --seed $SEED --quiet -o results/slurm-test/one.h5
h5diff --exclude-path /run results/slurm-test/one.h5 $OUTPUT || fail "other results"
echo "submitted again: the merged results are those of one run"

cd results/slurm-test
srun -n 2 --overcommit "$CREDENCE" run both.ini --trials 3000 --quiet --threads 1 --shard auto -o 'step-{shard}.h5'
"$CREDENCE" merge step-0.h5 step-1.h5 -o steps.h5 --quiet
"$CREDENCE" run both.ini --trials 3000 --quiet -o whole.h5
h5diff --exclude-path /run whole.h5 steps.h5 || fail "srun: other results"
echo "srun: its processes are shards, and merge to the results of one run"
