#!/usr/bin/env bash
# manual_lint.sh CREDENCE: what mandoc finds wrong with the manual page.
set -euo pipefail
command -v mandoc >/dev/null || { echo "SKIPPED: mandoc is not installed"; exit 0; }
"$1" manual | mandoc -T lint -W warning
