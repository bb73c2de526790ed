#!/usr/bin/env bash
# shelf.sh [LABEL...]: the labels that CI leaves out, or these, since all together take more than 40 minutes: docs, whose
# slow pages take minutes; compilers and digest, the committed digest from clang, from g++ on aarch64, in lanes of any
# width and on older processors, and the gallery by both; sanitizers, which compiles the tree once more; and contributing,
# which builds it with the diffs of CONTRIBUTING.md. To be run before a release, after tests/run.sh; when each last ran,
# and what came of it, is kept in tests/shelf.txt, which CI shows.
set -euo pipefail
cd "$(dirname "$0")/.."
labels=("$@")
[ $# -gt 0 ] || labels=(sanitizers digest compilers contributing docs)
cmake -S . -B build -DCREDENCE_ALL_LABELS=ON >/dev/null
revision=$(git rev-parse --short=12 HEAD)
git diff --quiet HEAD || revision+=" and changes"
status=0
for label in "${labels[@]}"; do
  log=build/shelf-$label.log start=$SECONDS result=passed
  ctest --test-dir build -L "^$label\$" --output-on-failure -V >"$log" 2>&1 || result=failed
  ! grep -q '\*\*\*Skipped\|No tests were found' "$log" || result=skipped
  [ $result = passed ] || { status=1; tail -n 40 "$log"; }
  line="$label: $result on $(date -u +%F) at $revision, in $((SECONDS - start)) s"
  { grep -v "^$label:" tests/shelf.txt || true; echo "$line"; } | sort >build/shelf.txt
  cp build/shelf.txt tests/shelf.txt
  echo "$line"
done
exit $status
