# Sourced by the scripts of the studies: builds the program, and makes tables of its reports.

source experiments/setup.sh

credence=${CREDENCE:-build/credence}

# Installs and builds missing parts of the program, unless CREDENCE names one.
build_program() {
  [ -z "${CREDENCE:-}" ] || return 0
  install_missing $build_packages
  local tests=()
  [ -f build/CMakeCache.txt ] || tests=(-DCREDENCE_TESTS=OFF)  # the tests need more packages: tests/run.sh turns them on
  build build credence "${tests[@]}"
}

# A run shows its progress on a terminal only; its report is made later.
quiet=$([ -t 2 ] || echo --quiet)

# study STEM TRIALS SCENARIO.ini [section.key=value | --sweep=section.key=VALUES ...]: runs the study, or resumes it,
# and writes its report: STEM.h5 and STEM.csv.
study() {
  local stem=$1 trials=$2 scenario=$3 settings=() setting
  shift 3
  for setting in "$@"; do
    case $setting in --*) settings+=("$setting") ;; *) settings+=(--set "$setting") ;; esac
  done
  mkdir -p "$(dirname "$stem")"
  "$credence" run "$scenario" -o "$stem.h5" --trials "$trials" "${settings[@]}" --resume $quiet >/dev/null
  "$credence" report "$stem.h5" --format csv >"$stem.csv"
}

# interval FILE.csv ARM FIGURE [SCENARIO]: `mean ± half-width` of a column, with two digits of the half-width; of the
# first scenario where none is named.
interval() {
  awk -F, -v arm="$2" -v figure="$3" -v scenario="${4:-}" '
    $2 == arm && $5 == figure && (scenario == "" || $1 == scenario) {
      half = ($10 - $9) / 2
      digits = half > 0 ? 1 - int(log(half) / log(10) - (half < 1)) : 4
      if (digits < 0) digits = 0
      printf "%.*f ± %.*f", digits, $7, digits, half
      exit
    }' "$1"
}

# verdict FILE.csv ARM [SCENARIO]
verdict() {
  awk -F, -v arm="$2" -v scenario="${3:-}" '$2 == arm && (scenario == "" || $1 == scenario) { print $17; exit }' "$1"
}

# points FILE.csv: the scenarios of a study swept over one key, each with its value.
points() { awk -F, 'NR > 1 && !seen[$1]++ { print $1, $19 }' "$1"; }
