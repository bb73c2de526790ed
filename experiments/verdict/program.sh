# Sourced with the name of a program of this folder, in the project's root: builds it, beside $CREDENCE where that is set.
# Sets `built`, the folder in which it is.
source experiments/setup.sh
if [ -n "${CREDENCE:-}" ]; then
  built=$(dirname "$CREDENCE")
  cmake --build "$built" --target "$1" >&2
else
  built=build
  install_missing $build_packages >&2
  tests=()
  [ -f build/CMakeCache.txt ] || tests=(-DCREDENCE_TESTS=OFF)
  build build "$1" "${tests[@]}" >&2
fi
