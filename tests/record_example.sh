#!/usr/bin/env bash
# record_example.sh CREDENCE COMMAND...: COMMAND FILE writes a record of a filter that is consistent.
set -euo pipefail
credence=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$@" "$work/example.h5"
"$credence" judge "$work/example.h5" --margin 6% --require consistent
