#!/usr/bin/env bash
# The engine's targets share no symbol: every symbol that one defines for others to link is in its own namespace, and it
# calls only the C library. Otherwise the linker could give an old processor a new one's instructions.
#   tests/target_symbols.sh TARGET OBJECT...
set -euo pipefail
target=$1
shift
defined=$(nm -C --defined-only --extern-only "$@" | grep ' ' || true)
called=$(nm -C --undefined-only "$@" | grep ' ' || true)
# (Where a name is too long for nm to read, it stays as the linker has it.)
others=$(grep -v " credence::$target::\| _ZZ*NK*8credence${#target}${target}[0-9]" <<<"$defined" || true
            grep -vE ' U (memcpy|memset|memmove|fma|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_)$' <<<"$called" || true)
for function in simulate simulate_explore simulate_own; do
  grep -q " T credence::$target::$function(" <<<"$defined" || { echo "target $target has no function $function"; exit 1; }
done
[ -z "$others" ] || { printf 'target %s defines or calls\n%s\n' "$target" "$others"; exit 1; }
echo "target $target: its own symbols only"
