#!/usr/bin/env bash
#SBATCH --job-name=credence-simulate
#SBATCH --ntasks=8
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=credence-%j.log
# Trials of a filter in Python on the processes of MPI, by mpi4py.futures: the first one has the study, the others work.
# Whatever ends it, what was done is kept; submitted again, it goes on. MPIRUN is the launcher: srun in a Slurm job, else
# mpirun.
#   FUNCTION=tracker:run TRIALS=1e5 OUTPUT=results/tracker.h5 sbatch --ntasks=64 experiments/cluster/simulate_mpi.sh
set -euo pipefail
: "${FUNCTION:?MODULE:FUNCTION, in this folder}" "${TRIALS:=1e4}" "${SEED:=1}" "${OUTPUT:=results/simulated.h5}"
: "${PYTHON:=python}" "${WORKERS:=2}"
: "${OPTIONS:=}"                              # further options of `python -m credence simulate`, such as --arm calm q=0.1
if [ -n "${SLURM_NTASKS:-}" ]; then default=srun; else default="mpirun -n $((WORKERS + 1))"; fi
: "${MPIRUN:=$default}"
mkdir -p "$(dirname "$OUTPUT")"
export PYTHONPATH=$PWD${PYTHONPATH:+:$PYTHONPATH}
# shellcheck disable=SC2086  # MPIRUN and OPTIONS are lists
exec $MPIRUN "$PYTHON" -m mpi4py.futures -m credence simulate "$FUNCTION" --trials "$TRIALS" --seed "$SEED" \
  --executor mpi --resume --quiet -o "$OUTPUT" $OPTIONS
