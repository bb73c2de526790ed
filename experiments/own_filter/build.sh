# Sourced by the scripts that build a project on an installed credence, as anybody's project is built.
#
# build_project FOLDER NAME [OPTION...]: builds the project of FOLDER in build/NAME, with CMake's options. In a
# checkout, credence is built and installed under build/installed first; where FOLDER was installed, it is that
# credence, and build/ is made in the folder that the script is called from. Sets `prefix`, where credence is installed.
build_project() {
  local folder=$1 project=build/$2
  shift 2
  if [ -f "$folder/../study.sh" ]; then
    cd "$folder/../.."
    source experiments/study.sh
    build_program >&2
    cmake --install build --prefix build/installed >build/installed.log
    prefix=$PWD/build/installed
  else
    prefix=$(cd "$folder/../../../.." && pwd)
  fi
  mkdir -p "$project"
  if declare -F with_progress >/dev/null; then
    with_progress "$project.log" configure_project "$folder" "$project" "$@" >&2
  else
    configure_project "$folder" "$project" "$@" >"$project.log" 2>&1 || { tail -n 30 "$project.log"; exit 1; }
  fi
}

configure_project() {
  local folder=$1 project=$2
  shift 2
  cmake -S "$folder" -B "$project" -DCMAKE_PREFIX_PATH="$prefix" "$@" && cmake --build "$project"
}
