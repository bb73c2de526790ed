#!/usr/bin/env bash
# Says of findings whose fault they are, the same ones together:
#   bash tests/fuzz/triage.sh TARGET [FILE...]      default: all of build-fuzz/findings/TARGET
# `hdf5` where the fault is in a function of libhdf5 that credence called, or in one of libc that this called; else
# `credence`. Ends with 1 if there is one of those.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$1
shift
source tests/fuzz/common.sh
export ASAN_OPTIONS=$ASAN_OPTIONS:malloc_context_size=30
[ $# -gt 0 ] || set -- build-fuzz/findings/"$target"/*

kinds='AddressSanitizer: [A-Za-z-]+|LeakSanitizer|runtime error: .*|does not hold: .*|Assertion .* failed'
kinds=$kinds'|uncaught exception.*|out-of-memory|timeout after'

# The frames of the fault itself, innermost first, as far as they are HDF5's or ours.
frames() {
  sed -n '/^ *#0 /,/^$/p' "$1" | sed '/^$/q' | grep -E '^ *#[0-9]+ .*(libhdf5|credence::|LLVMFuzzerTestOneInput)'
}

# One line of a finding: whose, what, and where.
signature() {
  local log=$1 what who='' where
  what=$(grep -oE "$kinds" "$log" | head -n 1 || true)
  [ -n "$what" ] || { echo "none: it does not happen again alone"; return; }
  where=$(frames "$log" | sed 's/(anonymous namespace):://g' || true)
  if head -n 1 <<<"$where" | grep -q libhdf5; then who=hdf5; else who=credence; fi
  [[ $what != "does not hold"* ]] || who=credence  # such as another file that HDF5 opens because we asked for it
  # A buffer of ours that HDF5 writes beyond would be our fault.
  if grep -q '^WRITE' "$log" && sed -n '/^allocated by/,/^$/p' "$log" | sed -n 2,4p | grep -q credence::; then
    who=credence
  fi
  # Up to the first function of ours: from there on the way is that of the reader.
  where=$(sed -nE 's/^ *#[0-9]+ 0x[0-9a-f]+ in ([A-Za-z_0-9:~]+).*/\1/p' <<<"$where" |
    sed '/^credence::/q' | head -n 20)
  echo "$who: $what: $(paste -sd '<' <<<"$where" | sed 's/</ < /g')"
}

# Runs a finding; its output is the file `log`. What did not end within 20 s will not end within 5.
run() {
  local limit=()
  [[ $(basename "$1") != timeout-* ]] || limit=(-timeout=5)
  timeout 120 "build-fuzz/tests/fuzz/fuzz_$target" "${limits[@]}" "${limit[@]}" "$1" >"$scratch/log" 2>&1 || true
}

# What happened and the addresses of the frames, without symbols, whose look-up takes most of the time.
addresses() {
  ASAN_OPTIONS=$ASAN_OPTIONS:symbolize=0 UBSAN_OPTIONS=$UBSAN_OPTIONS:symbolize=0 run "$1"
  { grep -oE "$kinds" "$scratch/log" | head -n 1
    sed -n '/^ *#0 /,/^$/p' "$scratch/log" | sed '/^$/q' | grep -oE '\([^ ]*\+0x[0-9a-f]+\)' || true; } | paste -sd ' '
}

declare -A alike=() firsts=()  # by addresses: how many, and the first
for file in "$@"; do
  key="$(addresses "$file") "
  alike[$key]=$((${alike[$key]:-0} + 1))
  firsts[$key]=${firsts[$key]:-$file}
done
for key in "${!alike[@]}"; do
  run "${firsts[$key]}"
  echo "$(signature "$scratch/log")|${firsts[$key]}|${alike[$key]}"
done | sort | awk -F'|' '{count[$1] += $3; if (!($1 in first)) first[$1] = $2}
  END {for (what in count) print count[what] " x " what "\n    " first[what]}' | tee "$scratch/findings"
# A file may claim to hold a thousand times its size, as compressed ones do: time and memory are shown, but no failure.
! grep " x credence" "$scratch/findings" | grep -qvE ": (out-of-memory|timeout after)"
