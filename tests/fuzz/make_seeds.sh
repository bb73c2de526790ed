#!/usr/bin/env bash
# Writes tests/fuzz/seeds/TARGET/: small valid files for the fuzz targets to start from.
#   bash tests/fuzz/make_seeds.sh [PROGRAM]      PROGRAM: credence, default build-fuzz/credence; also needs python3-h5py
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${1:-build-fuzz/credence}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
seeds=tests/fuzz/seeds
rm -rf "$seeds"
mkdir -p "$seeds"/{scenario,noise,judge,results}

cp experiments/seed/*.ini "$seeds/scenario/"
"$program" show >"$seeds/scenario/every-key.ini"
"$program" show --set scenario.world=explore >"$seeds/scenario/explore.ini"
printf '%s\n' '[noise]' 'walk = 0.2' 'heading = 0.1' '[sweep]' 'of = one' 'at = noise.walk=0.2, noise.heading=0.1' \
  >"$seeds/scenario/swept.ini"
# Overrides stand behind the text, each after a record separator.
printf '[model]\nprocess = translation\n\x1enoise.walk=1\x1eedges.graph=0-1, 1-2\x1escenario.title=a b' \
  >"$seeds/scenario/overrides"
printf '%s\n' '[features]' 'positions = 0 0, 1 1' '[sensor]' 'noise = ranged' '[arms]' 'controllers = greedy' \
  '[published]' 'trace_P = greedy.ekf 1' >"$seeds/scenario/published"

# A trial of one feature, two poses: results of a few kilobytes once what no reader needs is left out.
tiny=(--set scenario.poses=2 --set "features.positions=0.5 0.5" --quiet)
printf '[scenario]\nname = one\n' >"$work/one.ini"
printf '[scenario]\nname = two\n[model]\nprocess = translation\n' >"$work/two.ini"
"$program" run "$work/one.ini" "${tiny[@]}" --set arms.controllers=fixed --trials 3 -o "$work/heading.h5"
"$program" run "$work/two.ini" "${tiny[@]}" --trials 2 -o "$work/arms.h5"
"$program" run "$work/two.ini" "${tiny[@]}" --trials 2 --keep aggregates -o "$work/aggregates.h5"
"$program" run "$work/two.ini" "${tiny[@]}" --set arms.controllers=fixed --set scenario.poses=4 --trials 3 \
  -o "$work/lags.h5"
"$program" run "$work"/{one,two}.ini "${tiny[@]}" --set arms.controllers=greedy --trials 1 -o "$work/scenarios.h5"
"$program" run "$work/one.ini" "${tiny[@]}" --set arms.controllers=fixed --sweep noise.walk=0.2,0.3 --trials 1 \
  -o "$work/swept.h5"
printf '[scenario]\nname = three\nworld = explore\n[features]\ncount = 1\n[landmarks]\nmap = prior\n' >"$work/three.ini"
"$program" run "$work/three.ini" --set scenario.poses=2 --set arms.controllers=fixed --trials 1 --quiet -o "$work/landmarks.h5"
/usr/bin/python3 tests/fuzz/make_seeds.py "$work" "$seeds"
# Journals of runs that could not write their results: a limit on file sizes between the two. Of one block, and of two.
mkdir -p "$seeds/journal"
for keep in trials aggregates; do
  for trials in 3 257; do
    (ulimit -f 150
      "$program" run tests/fuzz/journal.ini --trials $trials --keep $keep --quiet -o "$work/run.h5") 2>/dev/null || true
    mv "$work/run.h5.journal" "$seeds/journal/$trials-$keep"
  done
done
find "$seeds" -type f -printf '%s %p\n' | sort -n | tail -n 3
