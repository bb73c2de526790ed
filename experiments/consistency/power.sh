#!/usr/bin/env bash
# Power of the verdict: the smallest factor on the reported P, above and below 1, that N = 1,000, 10,000 and 100,000
# trials detect with at least 80 % of the root seeds, by the verdict (margin 5 %) and by the classical band of ANEES (a
# step outside the joint 95 % band). Searched on steps of 0.05 %, by halving: for one root seed NEES scales with 1/P
# exactly, so trials that detect one factor detect a larger one too. Prints the table of docs/statistics.md; about four
# minutes on 2 cores.
#
#   bash experiments/consistency/power.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
scenario=experiments/consistency/matched-linear.ini

# look TRIALS FACTOR SEED: the verdict, and the steps of the whole state outside the joint band. Cached for other
# searches.
look() {
  local kept=$folder/$1-$2-$3 own=$folder/$1-$2-$3.$BASHPID
  if [ ! -f "$kept" ]; then
    "$program" run "$scenario" -o "$own.h5" --trials "$1" --seed "$3" --threads 1 --quiet --set "filter.covariance=$2"
    "$program" report "$own.h5" --format json >"$own.json"
    awk -F'[":, ]+' '$2 == "verdict" { verdict = $3 } $2 == "groups" { groups = 1 }
      groups && $2 == "steps_outside_simultaneous" { print verdict, $3; exit }' "$own.json" >"$own"
    rm "$own.h5" "$own.json"
    mv "$own" "$kept"
  fi
  cat "$kept"
}

# finds JUDGE SIDE TRIALS FACTOR SEEDS: whether at least 80 % of the seeds detect it. Ends as soon as this is known.
finds() {
  local seed verdict outside found=0 missed=0
  for ((seed = 1; seed <= $5; ++seed)); do
    read -r verdict outside < <(look "$3" "$4" "$seed") || { echo "no report of $3 trials, factor $4" >&2; exit 1; }
    if { [ "$1" = verdict ] && [ "$verdict" = "$2" ]; } || { [ "$1" = band ] && [ "$outside" -gt 0 ]; }; then
      found=$((found + 1))
    else
      missed=$((missed + 1))
    fi
    if ((5 * found >= 4 * $5)); then return 0; fi
    if ((5 * missed > $5)); then return 1; fi
  done
}

# search JUDGE SIDE TRIALS SEEDS: prints them with the factor. Between 0 and 12.8 % off, in 256 steps.
search() {
  local low=0 high=256 middle factor
  while ((high - low > 1)); do
    middle=$(((low + high) / 2))
    factor=$(awk -v off=$middle -v side="$2" 'BEGIN { printf "%.4f", 1 + (side == "pessimistic" ? 1 : -1) * off / 2000 }')
    if finds "$1" "$2" "$3" "$factor" "$4"; then high=$middle; else low=$middle; fi
  done
  awk -v off=$high -v judge="$1" -v side="$2" -v trials="$3" 'BEGIN {
    printf "%s %s %s %.4f\n", judge, side, trials, 1 + (side == "pessimistic" ? 1 : -1) * off / 2000 }'
}

if [ "${1:-}" = search ]; then
  shift
  search "$@"
  exit
fi

source experiments/study.sh
build_program >&2
export program=$credence folder OMP_NUM_THREADS=1  # searches run beside each other
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for trials in 100000 10000 1000; do
  seeds=40
  if [ $trials = 100000 ]; then seeds=20; fi
  for judge in verdict band; do
    for side in pessimistic optimistic; do echo "$judge $side $trials $seeds"; done
  done
done | xargs -P "$(nproc)" -L 1 bash experiments/consistency/power.sh search >"$folder/found"

cell() { awk -v judge="$1" -v side="$2" -v trials="$3" '$1 == judge && $2 == side && $3 == trials { print $4 }' "$folder/found"; }
echo '| trials | pessimistic: P × | optimistic: P × | ANEES joint band above 1 | below 1 |'
echo '|---|---|---|---|---|'
for trials in 1000 10000 100000; do
  echo "| $(sed 's/...$/,&/' <<<$trials) | $(cell verdict pessimistic $trials) | $(cell verdict optimistic $trials) |" \
    "$(cell band pessimistic $trials) | $(cell band optimistic $trials) |"
done
