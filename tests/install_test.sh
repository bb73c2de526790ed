#!/usr/bin/env bash
# install_test.sh BUILD SOURCE: what is installed works, and a user's project builds on it, that of docs/own-filter.md.
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rm -rf "$build/pages"  # a build of the program alone has none
cmake --install "$build" --prefix "$work/usr" >"$work/log" || { cat "$work/log"; exit 1; }
cd "$work"

credence=usr/bin/credence
[[ $($credence --version) == credence\ [0-9]* ]]
printf '[scenario]\nname = mine\n' >mine.ini
$credence show mine.ini | grep '^name = mine$' >/dev/null
if command -v help2man >/dev/null; then  # a page of each command, with its options
  for command in $($credence --help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p'); do
    grep -q '^\.TH CREDENCE' usr/share/man/man1/credence-"$command".1
  done
  grep -q '^\.TH CREDENCE' usr/share/man/man1/credence.1
  grep -qF -- '\-\-until' usr/share/man/man1/credence-run.1
fi
bash -c 'source usr/share/bash-completion/completions/credence; COMP_WORDS=(credence rep) COMP_CWORD=1; _credence
  [ "${COMPREPLY[*]}" = "report replay" ]' || { echo "the completion does not answer"; exit 1; }
for file in doc/credence/{README.md,LICENSE,CHANGELOG.md,docs/model.md} credence/analysis/record/write_record.py \
    credence/experiments/seed/ekf-circle-constant.ini; do
  [ -s "usr/share/$file" ] || { echo "share/$file is not installed"; exit 1; }
done

# Nothing of the machine that built it.
package=$(dirname "$(find usr -name credence-config.cmake)")
if grep -rnF -e "$build" -e "$source" -e "$work" "$package"; then echo "names a path of this machine"; exit 1; fi
if grep -nE -- '-Werror|-Wall|-fsanitize|-march' "$package"/credence-*.cmake; then echo "forces flags on others"; exit 1; fi

cmake -S "$source/tests/consumer" -B consumer -DCMAKE_PREFIX_PATH="$work/usr" >"$work/log" 2>&1 &&
  cmake --build consumer >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

# The installed example, in a folder of the user's, beside what comes next.
mkdir example
(cd example && bash ../usr/share/credence/experiments/own_filter/run.sh 2000) >example/said 2>&1 &
example=$!

# docs/own-filter.md, word for word, in an empty folder: its files, and its commands. ~/credence is what it installs.
page=usr/share/doc/credence/docs/own-filter.md
# block PATTERN: the fenced block of the page that has a line of that pattern.
block() {
  awk -v pattern="$1" '/^```/ { if (inside && found) { printf "%s", text; exit } inside = !inside; found = 0; text = ""; next }
    inside { text = text $0 "\n"; if ($0 ~ pattern) found = 1 }' "$page"
}
ln -s usr credence
mkdir own_filter
cp usr/share/credence/experiments/own_filter/tracker.hpp own_filter
block '^int main' >own_filter/main.cpp
block '^add_executable' >own_filter/CMakeLists.txt
block '^# tracker.ini' >own_filter/tracker.ini
{ block '^cmake -S . -B build'; block '^[$] build/tracker run' | sed -n 's/^[$] //p'; } >own_filter/commands
(cd own_filter && HOME=$work bash -e ./commands) >log 2>&1 || { cat log; exit 1; }
grep -q 'no CMAKE_BUILD_TYPE is given; Release is taken' log || { echo "no build type is taken"; exit 1; }
grep -rqs -e ' -O3 ' own_filter/build/CMakeFiles/tracker.dir own_filter/build/build.ninja ||
  { echo "the tracker is not optimised"; exit 1; }
cmake -S own_filter -B debug -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_BUILD_TYPE=Debug >log 2>&1 || { cat log; exit 1; }
if grep -q 'Release is taken' log; then echo "the user's build type is not kept"; exit 1; fi
wait $example || { cat example/said; exit 1; }
grep -q 'exit code 1, as it should be' example/said || { cat example/said; exit 1; }
[ -s example/results/tracker.h5 ] || { echo "the example leaves no results"; exit 1; }

# The planner of docs/planner.md as anybody's program. Any credence reads its file.
cp -r usr/share/credence/experiments/planner planner
cmake -S planner -B planner/build -DCMAKE_PREFIX_PATH="$work/usr" >log 2>&1 && cmake --build planner/build >>log 2>&1 ||
  { cat log; exit 1; }
curious() {
  planner/build/curious run usr/share/credence/experiments/explore/rooms.ini --set arms.controllers=greedy \
    --set scenario.poses=11 --trials 64 --quiet "$@"
}
curious --set arms.planners=curious --sweep planner.curious.weight=0,10 -o curious.h5 >/dev/null
$credence report curious.h5 --format csv >curious.csv
coverages() { awk -F, -v arm="$1.ekf" '$2 == arm && $5 == "coverage" { print $7 }' curious.csv | uniq | wc -l; }
[ "$(coverages greedy) $(coverages curious)" = "1 2" ] || { echo "the planner's key does nothing"; exit 1; }
for wrong in 'planner.curious.weight=-1' 'planner.curious.wait=1' 'planner.other.weight=1'; do
  status=0
  curious --set arms.planners=curious --set "$wrong" -o wrong.h5 >log 2>&1 || status=$?
  [ $status = 2 ] && grep -q "${wrong%=*}" log || { echo "$wrong: exit code $status"; cat log; exit 1; }
done

# Its world runs in lanes: every target of the engine gives the same file, from objects that share no symbol with others.
(cd own_filter
  targets=$(ls build/tracker_*.o | sed 's|build/tracker_\(.*\)\.o|\1|')
  for target in $targets; do
    others=$(nm --defined-only --extern-only "build/tracker_$target.o" | grep -v "8lanes_ofI7TrackerE" || true)
    [ -z "$others" ] || { printf 'tracker_%s.o shows others\n%s\n' "$target" "$others"; exit 1; }
    CREDENCE_FORCE_TARGET=$target build/tracker run tracker.ini --trials 1000 --quiet -o "$target.h5" 2>refused ||
      { grep -q 'cannot run it' refused || { cat refused; exit 1; }; continue; }
    build/tracker report "$target.h5" >"$target.said"
    cmp portable.said "$target.said"
  done)
cp -r own_filter nameless
sed -i '/^CREDENCE_WORLD/d' nameless/tracker.hpp
if cmake -S nameless -B nameless/other -DCMAKE_PREFIX_PATH="$work/usr" >log 2>&1 && cmake --build nameless/other >>log 2>&1; then
  echo "a header that names no world is built"; exit 1
fi
tr -s ' \n' ' ' <log | grep -q 'no header names its world. End it with CREDENCE_WORLD(World);' || { cat log; exit 1; }

mv own_filter/tracker.h5 own_filter/build/tracker .
# The program without that world says the same of the file, word for word.
./tracker report tracker.h5 --format json >own.json
$credence report tracker.h5 --format json >other.json
cmp own.json other.json
verdicts=$(grep -o '"verdict": *"[a-z]*"' own.json | tr -d ' "' | sort | uniq | tr '\n' ' ')
[ "$verdicts" = "verdict:consistent verdict:optimistic " ] || { echo "the verdicts are $verdicts"; exit 1; }
if $credence run --resume own_filter/tracker.ini -o tracker.h5 2>refusal; then exit 1; fi
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
