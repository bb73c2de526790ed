#!/usr/bin/env bash
# Runs the reference study: the four experiments of the document under both models, planned and fixed path, 10,000
# trials each; writes results/seed.h5 and shows its table. Installs and builds what is missing. Further arguments go to
# `credence run`, such as --trials 1e5.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/study.sh
build_program
mkdir -p results
"$credence" run experiments/seed/*.ini -o results/seed.h5 --resume "$@"
