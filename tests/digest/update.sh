#!/usr/bin/env bash
# Writes expected.txt anew from this tree's own units, which must agree. Results may change only with draws_version
# and a line of CHANGELOG.md that says why.
#   tests/digest/update.sh [BUILD [CMAKE ARGUMENT...]]
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/setup.sh
directory=${1:-build}
build "$directory" credence_digest_widths "${@:2}"
schema=$(sed -n 's/.* draws_version = \([0-9]*\);.*/\1/p' include/credence/study.hpp)
lines=$("$directory/tests/digest/credence_digest_widths")
printf 'schema %s\n%s\n' "$schema" "$lines" >tests/digest/expected.txt
