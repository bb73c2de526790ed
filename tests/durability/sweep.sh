#!/usr/bin/env bash
# Kills the program before every change that it makes to a file in turn, and after half of it; goes on; and shows that
# nothing committed was lost and the results are those of an undisturbed run.
# usage: sweep.sh CREDENCE [EVERY [OFFSET]]: in the long middle, where a results file is written, only every EVERY-th
# write from OFFSET on (default: all of them).
set -euo pipefail
source "$(dirname "$0")/common.sh"
every=${2:-1} offset=${3:-0}

# Of the killed runs, ../log: what had been committed when the last died, in bytes of the journal and in commits of
# blocks (its beginning, which is synced too, does not count). Of the run that went on, ../log2: the least that it left
# of the journal, and its appends. A journal that is shorter than before is another; the commits stay counted.
read_logs() {
  read -r committed commits least appends < <(awk '
    $2 !~ /\.journal$/ { next }
    FILENAME == "../log2" && $1 != "unlink" && (least == "" || $3 < least) { least = $3 }
    FILENAME == "../log2" && $1 ~ /^pwrite/ { appended = 1 }
    FILENAME == "../log2" && $1 == "fdatasync" { appends += appended; appended = 0 }
    FILENAME == "../log2" { next }
    $3 < committed { begun = committed = 0 }
    $1 ~ /^pwrite/ { written = 1 }
    $1 == "fdatasync" { committed = $3; commits += begun && written; begun = begun || written; written = 0 }
    END { print committed + 0, commits + 0, least == "" ? "none" : least, appends + 0 }' ../log ../log2)
}

# With a journal, going on leaves every byte of it that was committed. It runs on one thread, which appends block by
# block: so it computed no more than the blocks that no commit had. A journal that is gone is in the results file, and
# going on makes another.
check_kept() {
  local what=$1
  read_logs
  if [ "$committed" -eq 0 ] && [ "$commits" -eq 0 ]; then return; fi
  kept=$((kept + commits))
  if [ $journal = there ]; then
    [ "$least" = none ] || [ "$least" -ge "$committed" ] || fail "$what: of $committed bytes $least were kept"
  elif [ "$appends" -gt 0 ]; then
    appends=$((appends - 1))
  fi
  [ $((appends + commits)) -le "$blocks" ] || fail "$what: $commits commits, but $appends of $blocks blocks ran again"
}

# Where not even the journal's beginning was committed, a file that was to be replaced still belongs to another study.
go_on() {
  journal=gone
  if [ -s x.h5.journal ]; then journal=there; fi
  crashing "CRASH_LOG=../log2" "${again[@]}"
  read_logs
  if [ $status -eq 2 ] && [ "$committed" -eq 0 ] && grep -q 'another study' ../said && cmp -s "$before" x.h5; then
    refused=$((refused + 1))
    crashing "CRASH_LOG=../log2" "${command[@]}"
  fi
  [ $status -eq 0 ] || fail "$1: going on ended with $status"
}

# kill_at CHANGE HALF THREADS
kill_at() {
  local what="$name, change $1 of $total, half $2, $3 threads"
  start_with "$before"
  crashing "CRASH_AT=$1 CRASH_HALF=$2 CRASH_LOG=../log OMP_NUM_THREADS=$3 $environment" "${command[@]}"
  kills=$((kills + 1))
  if [ $status -ne 137 ]; then
    [ $status -eq 0 ] || [ $status -eq 3 ] || fail "$what: ended with $status"
    ended=$((ended + 1))
  fi
  if [ -e x.h5 ] && ! { [ -n "$before" ] && cmp -s "$before" x.h5; }; then
    "$credence" report x.h5 >../said 2>&1 || fail "$what: the file is neither the old one nor readable"
  fi
  # What goes on is killed too, a commit or so later: a journal is resumed that was resumed before.
  if [ "$blocks" -gt 0 ]; then crashing "CRASH_AT=6 CRASH_HALF=$2 CRASH_LOG=../log" "${again[@]}"; fi
  go_on "$what"
  check_kept "$what"
  check_whole "$what"
}

# sweep NAME BEFORE BLOCKS [ENVIRONMENT]: `command` on the file BEFORE computes BLOCKS blocks; `again` resumes it.
sweep() {
  local name=$1 before=$2 blocks=$3 environment=${4:-} kills=0 ended=0 kept=0 refused=0 total n
  count_changes "$environment"
  for ((n = 1; n <= total; ++n)); do
    if left_out $n; then continue; fi
    # The whole with one thread and half with two, then the other way round.
    kill_at $n 0 $((1 + n % 2))
    kill_at $n 1 $((2 - n % 2))
  done
  [ $kills -gt $ended ] || fail "$name: no run was killed"
  [ "$blocks" -eq 0 ] || [ $kept -gt 0 ] || fail "$name: no commit was ever synced"
  echo "$name: $total changes, $kills runs killed ($ended had ended before), $kept commits kept," \
    "$refused times nothing was committed yet of what replaces another study"
}

command=("${study[@]}") again=("${study[@]}" --resume --threads 1)
sweep fresh "" 6
sweep stopped "" 6 "CRASH_SIGNAL_AT=8"
command=("${study[@]}" --resume)
sweep grown ../less.h5 4
command=("${study[@]}" --overwrite)
sweep overwritten ../other.h5 6
command=(merge "${shards[@]}" -o x.h5 --quiet) again=(merge "${shards[@]}" -o x.h5 --quiet --overwrite) first=2
sweep merge "" 0
