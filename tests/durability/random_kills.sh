#!/usr/bin/env bash
# Kills a run of two threads at random times, and goes on with it each time, until COUNT kills came before its end: no
# results but those of an undisturbed run. What comes between two writes is met here; sweep.sh meets the rest.
# usage: random_kills.sh CREDENCE [COUNT]
set -euo pipefail
source "$(dirname "$0")/common.sh"
count=${2:-200}
RANDOM=20261
trials=100000
long=(run ../tiny.ini --trials $trials --quiet -o x.h5 --commit-every 1 --threads 2)
"$credence" run ../tiny.ini --trials $trials --quiet -o ../long.h5

kills=0 runs=0 done=0 rose=0
while [ $kills -lt "$count" ]; do
  rm -f x.h5
  ended=no
  while [ $ended = no ] && [ $kills -lt "$count" ]; do
    before=$(stat -c %s x.h5.journal 2>/dev/null || echo 0)
    "$credence" "${long[@]}" --resume >../said 2>&1 &
    run=$!
    sleep "0.$(printf %03d $((RANDOM % 200)))"
    kill -KILL $run 2>/dev/null || true
    status=0
    { wait $run; } 2>/dev/null || status=$?
    if [ $status -eq 0 ]; then
      ended=yes
    else
      [ $status -eq 137 ] || fail "a run ended with $status"
      kills=$((kills + 1))
      after=$(stat -c %s x.h5.journal 2>/dev/null || echo 0)
      if [ "$after" -gt "$before" ]; then rose=$((rose + 1)); fi
    fi
    runs=$((runs + 1))
  done
  if [ $ended = no ]; then "$credence" "${long[@]}" --resume >../said 2>&1 || fail "the last run"; fi
  [ "$(ls -A)" = x.h5 ] || fail "it left $(ls -A | tr '\n' ' ')"
  h5diff --exclude-path /run ../long.h5 x.h5 >../said 2>&1 || fail "other results"
  done=$((done + 1))
done
[ $rose -gt 0 ] || fail "no run that was killed had more in its journal than before"
echo "random kills: $kills of $runs runs killed, $rose with more in the journal than before, $done studies the same"
