#!/usr/bin/env bash
# The engine's targets share no symbol: every symbol that one defines for others to link is in its own namespace, and it
# calls only the C library. Otherwise the linker could give an old processor a new one's instructions.
#   tests/target_symbols.sh UNIT OBJECT...
set -euo pipefail
unit=$1
shift
defined=$(nm -C --defined-only --extern-only "$@" | grep ' ' || true)
called=$(nm -C --undefined-only "$@" | grep ' ' || true)
strangers=$(grep -v " credence::$unit::" <<<"$defined" || true
            grep -vE ' U (memcpy|memset|memmove|fma|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_)$' <<<"$called" || true)
for door in simulate simulate_landmarks; do
  grep -q " T credence::$unit::$door(" <<<"$defined" || { echo "unit $unit has no door $door"; exit 1; }
done
[ -z "$strangers" ] || { printf 'unit %s defines or calls\n%s\n' "$unit" "$strangers"; exit 1; }
echo "unit $unit: its own symbols only"
