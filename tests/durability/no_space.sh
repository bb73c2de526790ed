#!/usr/bin/env bash
# The system refuses: at every change to a file in turn as a full disk does, at some with other errors, and for real
# where this machine lets us. Each time one line says which file and what to do, the exit code is 1, and the run goes on
# later.
# usage: no_space.sh CREDENCE [EVERY [OFFSET]]: as in sweep.sh
set -euo pipefail
source "$(dirname "$0")/common.sh"
every=${2:-1} offset=${3:-0}

# One line, with the name of the file and after it a remedy; $2 is a part of it.
check_message() {
  [ "$(wc -l <../said)" -eq 1 ] || fail "$1: not one line was said"
  grep -qE 'x\.h5[^ ]* \(.*\)\. [A-Z]|^credence merge: .*\. [A-Z]' ../said || fail "$1: no file or no remedy is named"
  grep -qF "$2" ../said || fail "$1: it did not say $2"
}

# check_journal WHAT ERROR ONCE: a run says whether anything is kept. Its first sync of the journal is that of the
# beginning, which is nothing yet; then no journal is left, unless removing it was refused too.
check_journal() {
  if [ "${command[0]}" = merge ]; then
    [ ! -e x.h5.journal ] || fail "$1: a merge left a journal"
  elif [ -n "$before" ] || [ "$(grep -c '^fdatasync .*\.journal ' ../log)" -gt 1 ]; then
    grep -qF "What was committed is kept" ../said || fail "$1: it did not say that something is kept"
    [ -e x.h5 ] || [ -s x.h5.journal ] || fail "$1: nothing was kept"
  else
    nothing=$((nothing + 1))
    grep -qF "Nothing had been committed." ../said || fail "$1: it did not say that nothing had been committed"
    case $2$3 in
      ENOSPC | EDQUOT | *1) [ ! -e x.h5.journal ] || fail "$1: it left a journal of nothing" ;;
    esac
  fi
}

# The results file is what it was before, is not there, or is whole.
check_file() {
  if [ ! -e x.h5 ] || { [ -n "$before" ] && cmp -s "$before" x.h5; }; then return; fi
  h5diff --exclude-path /run ../whole.h5 x.h5 >/dev/null 2>&1 || fail "$1: the file is neither the old one nor whole"
}

# refuse_at CHANGE HALF ONCE ERROR WORDS
refuse_at() {
  local what="$name, $4 at change $1 of $total, half $2, once $3"
  start_with "$before"
  local environment="CRASH_LOG=../log CRASH_AT=$1 CRASH_ERROR=$4 ${2:+CRASH_HALF=$2} ${3:+CRASH_ONCE=$3}"
  crashing "$environment OMP_NUM_THREADS=$((1 + $1 % 2))" "${command[@]}"
  runs=$((runs + 1))
  # What removes or cuts is not refused by a full disk, and with two threads a run may be shorter.
  if grep -q '^refused' ../log; then
    refusals=$((refusals + 1))
    [ $status -eq 1 ] || fail "$what: it ended with $status"
    check_message "$what" "$5"
    check_journal "$what" "$4" "$3"
  else
    [ $status -eq 0 ] || fail "$what: nothing was refused, but it ended with $status"
  fi
  check_file "$what"
  crashing "" "${again[@]}"
  [ $status -eq 0 ] || fail "$what: going on ended with $status"
  check_whole "$what"
}

# refuse_everywhere NAME BEFORE: `command` on the file BEFORE; `again` goes on with it.
refuse_everywhere() {
  local name=$1 before=$2 runs=0 refusals=0 nothing=0 total n
  count_changes ""
  for ((n = 1; n <= total; ++n)); do
    if left_out $n; then continue; fi
    refuse_at $n "$([ $((n % 2)) -eq 1 ] || echo 1)" "" ENOSPC "no space left on device"
  done
  for n in 1 5 $((total / 2)) $((total - 4)) $((total - 3)) $((total - 1)) $total; do
    case $((n % 4)) in
      0) refuse_at $n "" 1 EIO "input/output error" ;;
      1) refuse_at $n "" "" EROFS "read-only file system" ;;
      2) refuse_at $n "" 1 EDQUOT "disk quota exceeded" ;;
      3) refuse_at $n "" "" EIO "input/output error" ;;
    esac
  done
  [ $refusals -gt 0 ] || fail "$name: nothing was refused"
  [ "$name" != fresh ] || [ $nothing -gt 0 ] || fail "$name: something had been committed each time"
  echo "$name: $total changes, $runs runs, $refusals refused with a message"
}

command=("${study[@]}") again=("${study[@]}" --resume)
refuse_everywhere fresh ""
command=("${study[@]}" --resume)
refuse_everywhere grown ../less.h5
command=(merge "${shards[@]}" -o x.h5 --quiet) again=(merge "${shards[@]}" -o x.h5 --quiet --overwrite) first=2
refuse_everywhere merge ""
before=""
source "$here/refused_for_real.sh"
