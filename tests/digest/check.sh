#!/usr/bin/env bash
# Whether a command succeeds and prints the committed digest.
#   tests/digest/check.sh COMMAND...
set -euo pipefail
expected=$(dirname "$0")/expected.txt
printed=$("$@") || { echo "failed with $?: $*"; exit 1; }
diff <(sed 1d "$expected") - <<<"$printed" || { echo "not the committed digest: $*"; exit 1; }
echo "the committed digest: $*"
