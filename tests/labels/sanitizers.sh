#!/usr/bin/env bash
# Label sanitizers: the core suite under the address and undefined-behaviour sanitizers, warnings as errors; but for the
# tests marked [long], which only repeat the same code for more trials.
set -euo pipefail
cmake --preset sanitizers >/dev/null
cmake --build --preset sanitizers --target credence_tests -j "$(nproc)" | tail -n 3
cd build-sanitizers
export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
tests/credence_tests '~[long]' | tail -n 30
