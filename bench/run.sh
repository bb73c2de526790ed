#!/usr/bin/env bash
# Builds the benchmarks in build-bench/ and runs them: parts, whole trials against baselines A and B, growth, threads
# and the whole program. Installs what is missing. Further arguments go to the benchmark program:
#   --quick    few repetitions      --json    the tables as JSON      --benchmark_filter=REGEX    Google Benchmark's own
# What it says of its progress goes to standard error, the tables to standard output.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/setup.sh
install_missing $build_packages libbenchmark-dev >&2
build build-bench credence_bench -DCMAKE_BUILD_TYPE=Release -DCREDENCE_BENCH=ON -DCREDENCE_TESTS=OFF >&2
build-bench/credence_bench "$@"
