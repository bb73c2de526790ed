#!/usr/bin/env bash
#SBATCH --job-name=credence-simulate
#SBATCH --ntasks=8
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=credence-%j.log
# Trials of a filter in Python on Dask's workers, one for each task of a Slurm job: a scheduler and the study on the first
# node, and workers by srun. Without Slurm it starts WORKERS workers on this machine. A minute before the time limit the
# study stops with everything kept; submitted again, it goes on.
#   FUNCTION=tracker:run TRIALS=1e5 OUTPUT=results/tracker.h5 sbatch --ntasks=64 experiments/cluster/simulate_dask.sh
set -euo pipefail
: "${FUNCTION:?MODULE:FUNCTION, in this folder}" "${TRIALS:=1e4}" "${SEED:=1}" "${OUTPUT:=results/simulated.h5}"
: "${PYTHON:=python}" "${WORKERS:=2}"
: "${OPTIONS:=}"                              # further options of `python -m credence simulate`, such as --arm calm q=0.1
mkdir -p "$(dirname "$OUTPUT")"
folder=$(mktemp -d -p "$(dirname "$OUTPUT")" dask-XXXXXX)
export DASK_SCHEDULER_FILE=$folder/scheduler.json PYTHONPATH=$PWD${PYTHONPATH:+:$PYTHONPATH}
processes=()
# shellcheck disable=SC2317  # the trap calls it
end() {
  kill "${processes[@]}" 2>/dev/null || true
  wait "${processes[@]}" 2>/dev/null || true
  rm -rf "$folder"
}
trap end EXIT

"$PYTHON" -m distributed.cli.dask_scheduler --scheduler-file "$DASK_SCHEDULER_FILE" --no-dashboard --port 0 &
processes+=($!)
worker=("$PYTHON" -m distributed.cli.dask_worker --scheduler-file "$DASK_SCHEDULER_FILE" --nthreads 1 --no-dashboard
  --local-directory "${TMPDIR:-/tmp}")
if [ -n "${SLURM_NTASKS:-}" ]; then
  srun "${worker[@]}" &
  processes+=($!)
else
  for ((i = 0; i < WORKERS; i++)); do
    "${worker[@]}" &
    processes+=($!)
  done
fi
for ((i = 0; i < 600; i++)); do
  [ ! -e "$DASK_SCHEDULER_FILE" ] || break
  sleep 0.1
done

# The shell must receive the signal, so the study runs in the background.
# shellcheck disable=SC2086  # OPTIONS is a list
"$PYTHON" -m credence simulate "$FUNCTION" --trials "$TRIALS" --seed "$SEED" --executor dask --resume --quiet \
  -o "$OUTPUT" $OPTIONS &
study=$!
trap 'kill -TERM $study' TERM
status=0
wait $study || status=$?
while kill -0 $study 2>/dev/null; do
  status=0
  wait $study || status=$?
done
exit $status
