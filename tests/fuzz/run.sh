#!/usr/bin/env bash
# Fuzzes the reader of one kind of file:
#   bash tests/fuzz/run.sh scenario|noise|judge|arrays|results|journal [SECONDS] [LIBFUZZER-OPTION...]
# Inputs that reach new code go to build-fuzz/corpus/TARGET, findings to build-fuzz/findings/TARGET; both outlive a run.
# After a finding it goes on in a new process. Ends with 1 if there are findings that are not HDF5's own (triage.sh).
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$1 seconds=${2:-60}
shift $(($# > 1 ? 2 : 1))
source tests/fuzz/common.sh
build_target "fuzz_$target"

corpus=build-fuzz/corpus/$target findings=build-fuzz/findings/$target log=$scratch/log
mkdir -p "$corpus" "$findings"
cp "build-fuzz/tests/fuzz/fuzz_$target" "$scratch/"  # so that a build does not change it under way
before=$(find "$findings" -type f | sort)
options=(-fork=1 -ignore_crashes=1 -ignore_ooms=1 -ignore_timeouts=1 -max_total_time="$seconds" "${limits[@]}"
  -max_len="$([ "$target" = scenario ] && echo 8192 || echo 131072)" -artifact_prefix="$findings/")
[ ! -f "tests/fuzz/$target.dict" ] || options+=(-dict="tests/fuzz/$target.dict")

folders=("$corpus")
for folder in tests/fuzz/{seeds,found}/"$target"; do  # `found`: what once failed
  [ ! -d "$folder" ] || folders+=("$folder")
done

# Symbols are for triage: here they would take most of the time of a finding.
ASAN_OPTIONS=$ASAN_OPTIONS:symbolize=0 UBSAN_OPTIONS=$UBSAN_OPTIONS:symbolize=0 \
  nice -n 15 "$scratch/fuzz_$target" "${options[@]}" "$@" "${folders[@]}" >"$log" 2>&1 || true

cp "$log" "build-fuzz/$target.log"
executions=$(grep -aoE '^#[0-9]+' "$log" | tail -n 1 | tr -d '#' || true)
mapfile -t new < <(comm -13 <(echo "$before") <(find "$findings" -type f | sort))
echo "$target: ${executions:-0} executions in $seconds s, $((${executions:-0} / seconds)) a second;" \
  "$(find "$corpus" -type f | wc -l) inputs kept, ${#new[@]} new findings"
[ "${executions:-0}" -gt 0 ] || { tail -n 20 "$log"; exit 1; }
[ ${#new[@]} -eq 0 ] || bash tests/fuzz/triage.sh "$target" "${new[@]}"
