#!/usr/bin/env bash
# Breaks the equations and protocols one at a time, as tests/mutants.txt says, and runs the core tests on each; where
# none fails, the tests of the label long, and then the digest, which changes with every bit: a mutant that only the
# digest notices may need a test that says more. Exits with 1 where nothing fails, where a mutant no longer applies, or
# where it does not compile. This tree is left as it is.
#   tests/mutants.sh [PATTERN]      only the mutants whose line matches the grep pattern; DRY=1 shows what would change
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d "${TMPDIR:-/tmp}/credence-mutants.XXXXXX")
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build
mkdir "$tree"
git ls-files -z | xargs -0 cp --parents -t "$tree"

compile() { cmake --build "$build" -j "$(nproc)" --target "$@" >"$work/compile.log" 2>&1; }
passes() { timeout 600 "$build/tests/$1" "${@:2}" >"$work/tests.log" 2>&1; }

# Prints the kind of test that fails, or nothing.
noticed_by() {
  if ! passes credence_tests '~[long]'; then echo "core"; return; fi
  compile credence_long_tests && ! passes credence_long_tests && { echo "long"; return; }
  bash "$tree/tests/digest/check.sh" "$build/tests/digest/credence_digest" >/dev/null 2>&1 || echo "the digest only"
}

if [ -z "${DRY:-}" ]; then
  cmake -S "$tree" -B "$build" -DCMAKE_UNITY_BUILD=ON -DCREDENCE_TESTS=ON >"$work/compile.log"
  compile credence_tests credence_digest || { cat "$work/compile.log"; exit 1; }
  noticed=$(noticed_by)
  if [ -n "$noticed" ]; then echo "tests fail before anything is broken: $noticed"; cat "$work/tests.log"; exit 1; fi
fi

count=0 bad=0
while IFS= read -r line; do
  name=${line%% :: *} rest=${line#* :: }
  file=${rest%% :: *} script=${rest#* :: }
  count=$((count + 1))
  sed -E -i "$script" "$tree/$file"
  if cmp -s "$file" "$tree/$file"; then
    echo "UNFIT    $name: nothing in $file matches"; bad=$((bad + 1))
  elif [ -n "${DRY:-}" ]; then
    echo "$name"; diff "$file" "$tree/$file" | grep '^[<>]' || true
  elif ! compile credence_tests credence_digest; then
    echo "UNFIT    $name: does not compile"; grep -m 3 error "$work/compile.log" || true; bad=$((bad + 1))
  else
    noticed=$(noticed_by)
    if [ -n "$noticed" ]; then echo "caught   $name ($noticed)"; else echo "SURVIVED $name"; bad=$((bad + 1)); fi
  fi
  cp "$file" "$tree/$file"
done < <(grep -vE '^(#|$)' tests/mutants.txt | grep -e "${1:-}")
echo "$count mutants, $bad survived or do not apply"
[ "$count" -gt 0 ] && [ "$bad" -eq 0 ]
