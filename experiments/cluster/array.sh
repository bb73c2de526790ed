#!/usr/bin/env bash
#SBATCH --job-name=credence
#SBATCH --array=0-7
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=credence-%A_%a.log
# One task of a Slurm job array: one shard of the study. submit.sh submits it, and `sbatch experiments/cluster/array.sh`
# does too. Any range of numbers will do for --array.
#
# A minute before the time limit Slurm sends this script a SIGTERM: credence ends with everything kept (exit code 3),
# and the task goes back into the queue. Whatever ended it, a task that starts again goes on where it was, and one that
# has nothing left to do ends at once: submit all of it again after any failure.
set -euo pipefail
source experiments/cluster/settings.sh
mkdir -p "$OUTPUT.parts"

# The shell must receive the signal, so the program runs in the background.
# shellcheck disable=SC2086  # STUDY and OPTIONS are lists
"$CREDENCE" run $STUDY --trials "$TRIALS" --seed "$SEED" --threads "${SLURM_CPUS_PER_TASK:-1}" \
  --shard auto --resume --quiet $OPTIONS -o "$OUTPUT.parts/part-{shard}.h5" &
program=$!
trap 'kill -TERM $program' TERM
status=0
wait $program || status=$?
# The signal ends the first wait; the program ends a little later.
while kill -0 $program 2>/dev/null; do
  status=0
  wait $program || status=$?
done
echo "$(date -u +%FT%TZ) task $SLURM_ARRAY_TASK_ID: credence ended with $status after ${SLURM_RESTART_COUNT:-0} restarts"

# A task that is cancelled by a user gets the signal too, but is no longer running.
if [ $status -eq 3 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt "$RESTARTS" ] &&
  [ "$(squeue -h -j "$SLURM_JOB_ID" -o %T)" = RUNNING ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit $status
