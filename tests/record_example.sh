#!/usr/bin/env bash
# record_example.sh CREDENCE COMMAND...: COMMAND FILE writes a record of a filter that is consistent; without a file it
# says what it needs, and exits with 2.
set -euo pipefail
credence=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
code=0
"$@" 2>"$work/said" || code=$?
if [ $code -ne 2 ] || ! grep -q '^usage: .*write_record' "$work/said" || grep -q Traceback "$work/said"; then
  echo "without a file: exit code $code and"; cat "$work/said"; exit 1
fi
"$@" "$work/example.h5"
"$credence" judge "$work/example.h5" --margin 6% --require consistent
