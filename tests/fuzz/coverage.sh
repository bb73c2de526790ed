#!/usr/bin/env bash
# Which lines of a reader its seeds and kept inputs reach, in percent for each source file:
#   bash tests/fuzz/coverage.sh TARGET [--missed]      --missed: and every line that they do not
# Inputs on which HDF5 crashes end a batch of 50, whose lines are then not counted.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$1 missed=${2:-}
source tests/fuzz/common.sh
folder=build-fuzz-coverage
flags="-fprofile-instr-generate -fcoverage-mapping"
cmake --preset fuzz -B $folder -DCREDENCE_SANITIZE= -DCMAKE_CXX_FLAGS="$flags" >/dev/null
nice -n 15 cmake --build $folder --target "fuzz_$target" -j "${FUZZ_JOBS:-1}" | tail -n 1

# Sources without their ending, or folders.
declare -A readers=(
  [scenario]="worlds/ini worlds/values worlds/deformable/keys worlds/deformable/settings worlds/explore/keys
    scenario/scenario scenario/common_keys scenario/sweep base/text"
  [noise]="files/trajectory/noise files/hdf5/read files/hdf5/handle"
  [arrays]="record worlds/own/step"
  [judge]="record files/record worlds/own/step files/hdf5/slab files/hdf5/read files/hdf5/handle"
  [results]="files/results study/hash numeric/exact_sum files/hdf5/dataset files/hdf5/read files/hdf5/handle"
  [journal]="files/journal report/watch/watch base/bytes"
)
sources=()
for name in ${readers[$target]}; do
  mapfile -t found < <(find "src/$name" src/"$name".[ch]pp -name '*.[ch]pp' 2>/dev/null)
  [ ${#found[@]} -gt 0 ] || { echo "no source src/$name"; exit 1; }
  sources+=("${found[@]}")
done

program=$folder/tests/fuzz/fuzz_$target
{ find tests/fuzz/{seeds,found}/"$target" build-fuzz/corpus/"$target" -type f 2>/dev/null || true; } |
  LLVM_PROFILE_FILE="$scratch/%p.profraw" xargs -n 50 sh -c '"$0" "$@" >/dev/null 2>&1 || true' "$program"
llvm-profdata merge -sparse "$scratch"/*.profraw -o "$scratch/all.profdata"
llvm-cov report "$program" -instr-profile="$scratch/all.profdata" "${sources[@]}" |
  awk '$1 ~ /pp$|^TOTAL$/ {printf "%-28s %6s of lines, %6s of branches\n", $1, $10, $13}'
[ "$missed" != --missed ] || llvm-cov show "$program" -instr-profile="$scratch/all.profdata" "${sources[@]}" |
  grep -E '^(/.*:$| +[0-9]+\| +0\|)'
