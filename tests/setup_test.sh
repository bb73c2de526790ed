#!/usr/bin/env bash
# setup_test.sh SOURCE: a build says how far it is, shows its log where it fails, and says what to install where a
# package is missing.
set -euo pipefail
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
expect() { grep -q -- "$1" "$work/said" || { echo "does not say: $1"; cat "$work/said"; exit 1; }; }

# A build of three seconds, or one that fails.
mkdir "$work/bin"
cat >"$work/bin/cmake" <<'CMAKE'
#!/bin/sh
[ "$1" = --build ] || exit 0
echo "[  7%] Building CXX object a.o"
sleep 1.5
echo "[ 42%] Building CXX object b.o"
sleep 1.5
[ ! -e "$2/broken" ]
CMAKE
chmod +x "$work/bin/cmake"
built() {
  PATH=$work/bin:$PATH bash -c 'set -euo pipefail
    source experiments/setup.sh
    build_progress_seconds=1
    build "$0" everything' "$work/build" >"$work/said" 2>&1
}
built || { cat "$work/said"; exit 1; }
expect "building everything in $work/build"
expect '^  7% after [12] s$'
expect '^  42% after [23] s$'
touch "$work/build/broken"
if built; then echo "a build that failed counts as done"; exit 1; fi
expect '^\[ 42%\] Building CXX object b.o$'
expect "the build failed; all of it is in $work/build/build.log"

if cmake -S . -B "$work/missing" -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON \
    -DCREDENCE_TESTS=OFF >"$work/said" 2>&1; then
  echo "is configured without Boost"
  exit 1
fi
expect 'credence needs Boost, nlohmann_json, which CMake cannot find'
source experiments/setup.sh
expect "apt-get install $(echo $build_packages)"
