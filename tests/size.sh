#!/usr/bin/env bash
# The size of the project, counted whole: lines of the product in C++, of the tests (all text but the seeds of fuzzing and
# stored files) and of the Python package, and words of the pages.
set -euo pipefail
cd "$(dirname "$0")/.."
text() { git ls-files -z "$@" | xargs -0 grep -lIZ '' | xargs -0 cat; }
printf '%-42s %6d %s\n' \
  'product (src include), C++' "$(text 'src/*.[ch]pp' 'include/*.[ch]pp' | wc -l)" lines \
  'tests (tests python/tests)' "$(text tests python/tests ':!tests/fuzz/seeds' ':!tests/fuzz/found' | wc -l)" lines \
  'Python package (python/credence)' "$(text 'python/credence/*.py' 'python/credence/*.pyi' | wc -l)" lines \
  'docs' "$(text 'docs/*.md' | wc -w)" words \
  'README CHANGELOG CONTRIBUTING' "$(text README.md CHANGELOG.md CONTRIBUTING.md | wc -w)" words
