#!/usr/bin/env bash
# Label sanitizers: the whole core suite under the address and undefined-behaviour sanitizers, warnings as errors.
set -euo pipefail
cmake --preset sanitizers >/dev/null
cmake --build --preset sanitizers --target credence_tests -j "$(nproc)" | tail -n 3
cd build-sanitizers
export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
tests/credence_tests '~[slow]' | tail -n 30
