# Sourced by the project's scripts: installs what is missing from the distribution, and builds.

# Installs those of the named packages that are missing (Debian 12, Ubuntu 22.04 and later).
install_missing() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "cannot install ${missing[*]} (neither root nor sudo)." >&2; return 1; }
    as_root=(sudo)
  fi
  echo "installing: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! "${as_root[@]}" apt-get update -qq >"$log" 2>&1; then cat "$log" >&2; return 1; fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      "${missing[@]}" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    return 1
  fi
  rm -f "$log"
}

build_packages="g++ cmake make ninja-build libeigen3-dev libboost-program-options-dev libhdf5-dev libdeflate-dev
  nlohmann-json3-dev"
test_packages="catch2 librandom123-dev hdf5-tools"

# python_venv FOLDER REQUIREMENTS [WHAT…]: makes the Python environment FOLDER with WHAT and what the file REQUIREMENTS
# names, unless there is one that is newer than the file.
python_venv() {
  if [ "$1/complete" -nt "$2" ]; then return 0; fi
  echo "making the Python environment $1; if it compiles credence, that takes some minutes" >&2
  /usr/bin/python3 -m venv "$1"
  "$1/bin/pip" install --quiet --disable-pip-version-check "${@:3}" -r "$2" >&2
  touch "$1/complete"
}

# credence_python: sets CREDENCE_PYTHON to an interpreter that has credence and what python/requirements.txt names. Unless
# it is one already, they are installed once in build/in-the-wild, credence from this tree; remove that folder to have a
# newer credence. Trials have processes of their own, and sums of matrices must not depend on threads.
credence_python() {
  if [ -z "${CREDENCE_PYTHON:-}" ]; then
    python_venv build/in-the-wild python/requirements.txt .
    CREDENCE_PYTHON=$PWD/build/in-the-wild/bin/python
  fi
  export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
}

build_progress_seconds=10

# show_progress LOG: says every ten seconds how much of a build is done, until it is killed or the script ends.
show_progress() {
  local start=$SECONDS done_part
  while sleep "$build_progress_seconds" >/dev/null 2>&1 && kill -0 $$ 2>/dev/null; do
    done_part=$(grep -o '^\[[^]]*\]' "$1" | tail -n 1 | tr -d '[ ]' || true)
    echo "  ${done_part:-at work} after $((SECONDS - start)) s"
  done
}

# with_progress LOG COMMAND...: runs a build, its output in LOG, and says its progress; shows LOG's end where it fails.
with_progress() {
  local log=$1 progress status=0
  shift
  : >"$log"
  show_progress "$log" &
  progress=$!
  "$@" >"$log" 2>&1 || status=1
  kill "$progress" 2>/dev/null || true
  wait "$progress" 2>/dev/null || true
  [ $status -eq 0 ] && return 0
  tail -n 60 "$log" >&2
  echo "the build failed; all of it is in $log" >&2
  return 1
}

# build DIRECTORY TARGET [cmake arguments]: configures and builds, saying its progress.
build() {
  local directory=$1 target=$2
  shift 2
  mkdir -p "$directory"
  echo "building $target in $directory"
  with_progress "$directory/build.log" configure_and_build "$directory" "$target" "$@"
}

configure_and_build() {
  local directory=$1 target=$2
  shift 2
  # make waits for a library before it compiles what links it, which takes a fifth of the time on two cores.
  local generator=()
  [ -f "$directory/CMakeCache.txt" ] || generator=(-G Ninja)
  cmake -S . -B "$directory" "${generator[@]}" -DCMAKE_UNITY_BUILD=ON "$@" &&
    cmake --build "$directory" --target "$target" -j "$(nproc)"
}
