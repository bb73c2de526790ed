#!/usr/bin/env bash
#SBATCH --job-name=credence-merge
#SBATCH --time=01:00:00
#SBATCH --output=credence-%j-merge.log
# Makes one results file of the parts that array.sh wrote. Fails, and names the blocks, where some are missing.
set -euo pipefail
source experiments/cluster/settings.sh
for journal in "$OUTPUT.parts"/part-*.h5.journal; do
  [ ! -e "$journal" ] || echo "$journal: this task has not ended" >&2
done
parts=("$OUTPUT.parts"/part-*.h5)
[ -e "${parts[0]}" ] || { echo "$OUTPUT.parts: no part is there" >&2; exit 1; }
"$CREDENCE" merge "${parts[@]}" -o "$OUTPUT" --overwrite
