#!/usr/bin/env bash
# install_test.sh BUILD SOURCE: what is installed works, and somebody else's project builds on it.
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/usr" >"$work/log" || { cat "$work/log"; exit 1; }
cd "$work"

credence=usr/bin/credence
[[ $($credence --version) == credence\ [0-9]* ]]
printf '[scenario]\nname = mine\n' >mine.ini
$credence show mine.ini | grep -q '^name = mine$'
grep -q '^\.TH CREDENCE 1' usr/share/man/man1/credence.1
bash -c 'source usr/share/bash-completion/completions/credence; COMP_WORDS=(credence rep) COMP_CWORD=1; _credence
  [ "${COMPREPLY[*]}" = "report replay" ]' || { echo "the completion does not answer"; exit 1; }
for file in doc/credence/{README.md,LICENSE,CHANGELOG.md,docs/model.md} credence/analysis/record/write_record.py \
    credence/experiments/seed/ekf-circle-constant.ini; do
  [ -s "usr/share/$file" ] || { echo "share/$file is not installed"; exit 1; }
done

# Nothing of the machine that built it.
package=$(dirname "$(find usr -name credence-config.cmake)")
if grep -rnF -e "$build" -e "$source" -e "$work" "$package"; then echo "names a path of this machine"; exit 1; fi
if grep -nE -- '-Werror|-Wall|-fsanitize|-march' "$package"/*.cmake; then echo "forces flags on others"; exit 1; fi

cmake -S "$source/tests/consumer" -B consumer -DCMAKE_PREFIX_PATH="$work/usr" >"$work/log" 2>&1 &&
  cmake --build consumer >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake -S "$source/experiments/own_filter" -B own_filter -DCMAKE_PREFIX_PATH="$work/usr" >"$work/log" 2>&1 &&
  cmake --build own_filter >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
own_filter/tracker run "$source/experiments/own_filter/tracker.ini" --trials 4000 --quiet -o tracker.h5
# The program without that world says the same of the file, word for word.
own_filter/tracker report tracker.h5 --format json >own.json
$credence report tracker.h5 --format json >other.json
cmp own.json other.json
verdicts=$(grep -o '"verdict": *"[a-z]*"' own.json | tr -d ' "' | sort | uniq | tr '\n' ' ')
[ "$verdicts" = "verdict:consistent verdict:optimistic " ] || { echo "the verdicts are $verdicts"; exit 1; }
if $credence run --resume "$source/experiments/own_filter/tracker.ini" -o tracker.h5 2>refusal; then exit 1; fi
grep -q 'scenario.world=tracker (this program has no such world)' refusal

consumer/mean >means
$credence run mine.ini --trials 256 --quiet -o mine.h5
$credence report mine.h5 --format csv >report.csv
[ "$(wc -l <means)" -eq 2 ]
while IFS=, read -r scenario arm figure mean; do
  grep -q "^$scenario,$arm,256,0,$figure,.*,$mean," report.csv ||
    { echo "the program has another mean than $mean"; exit 1; }
done <means
cat means
