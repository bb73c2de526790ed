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
[ -f results/seed.h5 ] || exit 0  # --dry-run
cat <<END

What next: README.md says how to read this table, and docs/reference-study.md has the whole study.
  $credence report results/seed.h5 --format html -o results/seed.html     # a page with pictures
  $credence run my.ini -o my.h5                                           # a scenario of your own: docs/running.md
END
