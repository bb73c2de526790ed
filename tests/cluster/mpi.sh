#!/usr/bin/env bash
# Runs that the ranks of mpirun share: the same bytes for any number of ranks and threads, after a rank was killed,
# after a signal; one message for bad input.
# usage: mpi.sh CREDENCE   (built with MPI; needs mpirun and h5diff)
set -euo pipefail
credence=$(realpath "$1")
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_orte_abort_print_stack=0
mpi="mpirun --quiet"

cat >both.ini <<'INI'
[scenario]
name = both
poses = 12
INI
cp "$tests/durability/tiny.ini" .
cat >slow.ini <<'INI'
[scenario]
name = slow
poses = 300
INI

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 said >&2
  ls -l >&2
  exit 1
}

# same A B: outside /run.
same() { h5diff --exclude-path /run "$1" "$2" >said 2>&1 || fail "$3: other results"; }

# ends CODE WHAT COMMAND...
ends() {
  local code=$1 what=$2 status=0
  shift 2
  "$@" >said 2>&1 || status=$?
  [ $status -eq "$code" ] || fail "$what: ended with $status"
}

ranks_and_threads() {
  local ranks threads study=(both.ini tiny.ini --trials 9100 --quiet)
  ends 0 "one process" "$credence" run "${study[@]}" -o one.h5
  for ranks in 1 2 4; do
    for threads in 1 2; do
      ends 0 "$ranks ranks" $mpi -n $ranks "$credence" run "${study[@]}" --threads $threads -o x.h5
      same one.h5 x.h5 "$ranks ranks of $threads threads"
      rm x.h5
    done
  done
  ends 0 "shard 1" $mpi -n 2 "$credence" run "${study[@]}" --threads 1 --shard 1/3 -o part-1.h5
  ends 0 "shards by rank" $mpi -n 3 "$credence" run "${study[@]}" --threads 1 --shard auto -o 'own-{shard}.h5'
  same part-1.h5 own-1.h5 "a shard of two ranks, and of one of mpirun's processes"
  ends 0 merge "$credence" merge own-?.h5 -o x.h5
  same one.h5 x.h5 "processes of mpirun as shards"
  rm x.h5
  echo "ranks and threads: the same results from 1, 2 and 4 ranks of 1 and 2 threads, and as shards"
}

until_precise() {
  local study=(tiny.ini --until trace_P=1% --quiet)
  ends 0 "--until alone" "$credence" run "${study[@]}" -o until.h5
  ends 0 "--until" $mpi -n 3 "$credence" run "${study[@]}" --threads 1 -o x.h5
  same until.h5 x.h5 "--until"
  rm x.h5
  echo "until: the same stop"
}

bad_input() {
  ends 2 "no such scenario" $mpi -n 3 "$credence" run none.ini
  [ "$(grep -c '^credence' said)" -eq 1 ] || fail "no such scenario: not one message"
  ends 2 "an unknown option" $mpi -n 3 "$credence" run tiny.ini --bogus
  [ "$(grep -c '^credence' said)" -eq 1 ] || fail "an unknown option: not one message"
  cp one.h5 there.h5
  ends 2 "an output that is there" $mpi -n 3 "$credence" run tiny.ini -o there.h5
  [ "$(grep -c '^credence' said)" -eq 1 ] || fail "an output that is there: not one message"
  cmp -s one.h5 there.h5 || fail "an output that is there: it was changed"
  echo "bad input: exit 2 and one message"
}

# started RANKS: a long run in the background, `job` being mpirun, until something was committed; sets pid[RANK].
started() {
  local process
  $mpi -n "$1" "$credence" run "${long[@]}" --threads 1 -o x.h5 >said 2>&1 &
  job=$!
  until [ "$(stat -c %s x.h5.journal 2>/dev/null || echo 0)" -gt 30000 ]; do
    kill -0 $job 2>/dev/null || fail "the long run ended at once"
    sleep 0.02
  done
  for process in $(pgrep -P $job); do
    pid[$(tr '\0' '\n' <"/proc/$process/environ" | sed -n 's/^OMPI_COMM_WORLD_RANK=//p')]=$process
  done
}

long=(slow.ini --trials 2900 --quiet --commit-every 1)
disturbed() {
  local rank status
  declare -a pid
  ends 0 "the long run alone" "$credence" run "${long[@]}" -o long.h5
  for rank in 1 0; do
    started 3
    kill -KILL "${pid[$rank]}"
    status=0
    wait $job || status=$?
    [ $status -ne 0 ] || fail "rank $rank was killed, and mpirun says that all went well"
    [ ! -e x.h5 ] && [ -s x.h5.journal ] || fail "rank $rank was killed: no journal is left"
    ends 0 "going on after rank $rank was killed" $mpi -n 2 "$credence" run "${long[@]}" --threads 1 -o x.h5 --resume
    same long.h5 x.h5 "rank $rank was killed"
    rm x.h5
  done
  echo "a rank killed: the job ends with an error, and going on gives the same results"
  # A rank that gets the signal alone: all of them stop in order.
  for rank in 2 0; do
    started 3
    kill -TERM "${pid[$rank]}"
    status=0
    wait $job || status=$?
    [ $status -eq 3 ] || fail "SIGTERM to rank $rank: ended with $status"
    grep -q "stopped by SIGTERM" said || fail "SIGTERM to rank $rank: not told"
    [ -e x.h5 ] && [ ! -e x.h5.journal ] || fail "SIGTERM to rank $rank: no results file"
    ends 0 "going on after SIGTERM" $mpi -n 2 "$credence" run "${long[@]}" --threads 1 -o x.h5 --resume
    same long.h5 x.h5 "SIGTERM to rank $rank"
    rm x.h5
  done
  # mpirun passes its own on, and gives the ranks a second.
  started 2
  kill -TERM $job
  status=0
  wait $job || status=$?
  [ $status -ne 0 ] || fail "SIGTERM to mpirun: it says that all went well"
  ends 0 "going on after mpirun's SIGTERM" $mpi -n 2 "$credence" run "${long[@]}" --threads 1 -o x.h5 --resume
  same long.h5 x.h5 "SIGTERM to mpirun"
  rm x.h5
  echo "signals: everything kept (mpirun ended with $status), and going on gives the same results"
}

ranks_and_threads
until_precise
bad_input
disturbed
