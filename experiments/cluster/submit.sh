#!/usr/bin/env bash
# Runs a study as a Slurm job array and merges its parts. Called in the project's folder, and again after any failure:
# what is done stays done. Arguments go to sbatch, such as --partition=long or --account=me.
#   SHARDS=100 TRIALS=1e8 STUDY=experiments/seed/ekf-circle-ranged.ini bash experiments/cluster/submit.sh
set -euo pipefail
source experiments/cluster/settings.sh
array=$(sbatch --parsable --array="0-$((SHARDS - 1))" "$@" experiments/cluster/array.sh)
array=${array%%;*}
# afterany, not afterok: a task that was killed and put back counts as failed for good. The merge itself sees what is
# missing.
merge=$(sbatch --parsable --dependency="afterany:$array" "$@" experiments/cluster/merge.sh)
echo "array $array, then merge ${merge%%;*} to $OUTPUT (credence-$array"'_*.log, '"credence-${merge%%;*}-merge.log)"
