#!/usr/bin/env bash
# Breaks the equations one at a time, as tests/mutants/list.txt says, and runs the tests of rooms 1 to 10 on each; where
# none notices, the digest, which notices every bit: a mutant that only it catches may want a test that says more.
# Ends with 1 where nothing notices, where a mutant no longer applies, or where it does not compile.
#   tests/mutants.sh [PATTERN]      only the mutants whose line matches the grep pattern
# JOBS (2) compilers at once; 10 to 20 s a mutant on two idle cores, minutes for one that nothing notices. Nothing in
# this tree is touched. The tests nearest to the broken file run first, as only they need compiling again; all the others
# run where those notice nothing.
# VERBOSE=1 names the tests that notice; ALL=1 runs all tests on every mutant; DRY=1 runs nothing and shows what changes.
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d "${TMPDIR:-/tmp}/credence-mutants.XXXXXX")
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build sound=$work/sound original=$work/original
mkdir -p "$tree" "$build"
cp -a include src tests "$tree"
cp -a "$tree" "$original"

# compile [TESTS]: the program with these tests, or with all.
compile() {
  rm -f "$build/core_tests"
  run_make ${1:+"TESTS=$1"}
}
run_make() {
  make -s -j "${JOBS:-2}" -f "$tree/tests/mutants/Makefile" ROOT="$tree" BUILD="$build" "$@" >"$work/compile.log" 2>&1
}

# Tests nearest to a file; none where only few files must be compiled again anyway.
nearest() {
  local whole="filter_oracle_test keys_test"  # whole trials; they see the engine through support.cpp only
  case "$1" in
    *sweep.cpp) echo sweep_test ;;
    *elementary.hpp) echo elementary_test ;;
    *real.hpp) echo elementary_test sensor_test ;;
    *pose_draws.hpp) echo world_test trial_test "$whole" ;;
    *draws.hpp) echo draws_test draws_statistics_test ;;
    *world.hpp) echo world_test trial_test "$whole" ;;
    *sensor.hpp) echo sensor_test trial_test "$whole" ;;
    *filter.hpp) echo filter_test "$whole" ;;
    *belief.hpp | *update.hpp | *condition.hpp) echo filter_belief_test status_test "$whole" ;;
    *edges.hpp) echo evidence_test filter_belief_test ;;
    *judge.hpp | *detail.hpp | *chi_square.hpp) echo evidence_test ;;
    *aggregates.cpp | *superaccumulator.hpp | *paired.cpp) echo aggregates_test ;;
    *block_ranges.cpp) echo block_ranges_test ;;
    *evidence*.cpp | *goodness.cpp | *consistency*.cpp) echo evidence_test consistency_test consistency_note_test goodness_test ;;
    *controller.hpp) echo controller_test planner_test "$whole" ;;
    *horizon.hpp) echo horizon_test ;;
    *planner.hpp | *screening.hpp | *measurement_space.hpp | *visible_sets.hpp | *turned_trace.hpp)
      echo planner_test controller_test ;;
    *initialise.hpp | *landmark*) echo landmarks_test ;;
    *estimator*.hpp | *ideal.hpp | *first_estimates.hpp | *right_invariant.hpp | *iterated.hpp)
      echo estimators_test landmarks_test ;;
    *trial.hpp) echo trial_test status_test "$whole" ;;
    *lane.hpp) echo lane_test block_test evidence_test ;;
    *simulate_unit.cpp | *simulate_batch.hpp | *Makefile) echo block_test evidence_test ;;
  esac
}

# failures [TESTS]: names of the tests that fail, one a line; a crash or a hang counts as one. Where all tests are there,
# forcing an unknown unit must fail too: units_test, which needs the program, is not among them.
failures() {
  local status=0 names
  timeout "${LIMIT:-300}" "$build/core_tests" '~[long]' --reporter xml >"$work/tests.xml" 2>"$work/tests.log" || status=$?
  names=$(sed -nE 's/.*<TestCase name="([^"]*)".*/\1/p; /<OverallResult success="false"/p' "$work/tests.xml" |
    awk '/OverallResult/ { print name; next } { name = $0 }')
  if [ -z "$names" ] && [ "$status" -ne 0 ]; then names="(stopped with status $status)"; fi
  if [ -z "$names" ] && [ -z "${1:-}" ] &&
    CREDENCE_FORCE_UNIT=none timeout 60 "$build/core_tests" "block: 100 trials are*" >/dev/null 2>&1; then
    names="(forcing a unit)"
  fi
  echo "$names"
}

# Fails where the digest of the tree is not the committed one, and says so.
digest() {
  if ! run_make "$build/credence_digest"; then echo "(the digest does not compile)"; return; fi
  timeout "${LIMIT:-300}" bash "$tree/tests/digest/check.sh" "$build/credence_digest" >/dev/null 2>&1 || echo "(the digest only)"
}

if [ -z "${DRY:-}" ]; then
  compile || { cat "$work/compile.log"; exit 1; }
  noticed=$(failures)
  if [ -z "$noticed" ]; then noticed=$(digest); fi
  if [ -n "$noticed" ]; then echo "the tests fail before anything is broken:"; echo "$noticed"; exit 1; fi
  cp -a "$build" "$sound"
fi

count=0 survived=0 unfit=0
while IFS= read -r line; do
  name=${line%% :: *} rest=${line#* :: }
  file=${rest%% :: *} script=${rest#* :: }
  count=$((count + 1))
  if [ -z "${DRY:-}" ]; then rm -rf "$build" && cp -a "$sound" "$build"; fi
  sed -E -i "$script" "$tree/$file"
  if cmp -s "$original/$file" "$tree/$file"; then
    echo "UNFIT    $name: nothing in $file matches"; unfit=$((unfit + 1))
  elif [ -n "${DRY:-}" ]; then
    echo "$name"; diff "$original/$file" "$tree/$file" | grep '^[<>]' || true
  else
    near=$(nearest "$file") noticed=
    if [ -n "${ALL:-}" ]; then near=; fi
    if ! compile "$near"; then
      echo "UNFIT    $name: does not compile"; grep -m 3 error "$work/compile.log" || true; unfit=$((unfit + 1))
    else
      noticed=$(failures "$near")
      if [ -z "$noticed" ] && [ -n "$near" ]; then compile && noticed=$(failures); fi
      if [ -z "$noticed" ]; then noticed=$(digest); fi
      if [ -n "$noticed" ]; then
        case "$noticed" in
          "("*) echo "caught   $name $noticed" ;;
          *) echo "caught   $name ($(wc -l <<<"$noticed") tests)" ;;
        esac
        if [ -n "${VERBOSE:-}" ]; then sed 's/^/           /' <<<"$noticed"; fi
      else
        echo "SURVIVED $name"; survived=$((survived + 1))
      fi
    fi
  fi
  cp -p "$original/$file" "$tree/$file"
done < <(grep -vE '^(#|$)' tests/mutants/list.txt | grep -e "${1:-}")
echo "$count mutants, $survived survived, $unfit unfit"
[ "$count" -gt 0 ] && [ "$survived" -eq 0 ] && [ "$unfit" -eq 0 ]
