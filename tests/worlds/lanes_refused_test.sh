#!/usr/bin/env bash
# What lanes cannot do fails to compile, with a sentence that says what to write instead.
#   lanes_refused_test.sh SOURCE_FOLDER CXX EIGEN_FOLDER
set -euo pipefail
source=$1 cxx=$2 eigen=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The headers are parsed once.
mkdir "$work/credence"
for header in own_trial own_world; do
  "$cxx" -std=c++20 -w -I"$source/include" -isystem "$eigen" -x c++-header "$source/include/credence/$header.hpp" \
    -o "$work/credence/$header.hpp.gch"
done

# compiles NAME CODE: whether a filter with this line compiles; its messages are in NAME.log.
compiles() {
  local header=own_trial
  [[ $2 != *add_own_world* ]] || header=own_world
  printf '%s\n' "#include <credence/$header.hpp>" '#include <cmath>' 'using namespace credence; using Real = Lane<4>;' \
    'Real filter(Real x, Real y, Eigen::Matrix<Real, 5, 5> S, Eigen::Matrix<Real, 5, 1> b) {' "$2" \
    'return x + y + S(0) + b(0); }' >"$work/$1.cpp"
  "$cxx" -std=c++20 -fsyntax-only -w -I"$work" -I"$source/include" -isystem "$eigen" "$work/$1.cpp" >"$work/$1.log" 2>&1
}
# refused NAME SENTENCE CODE
refused() {
  if compiles "$1" "$3"; then echo "$1: compiles: $3"; return 1; fi
  grep -q "error: .*$2" "$work/$1.log" || { echo "$1: not the sentence of $3"; head -n 20 "$work/$1.log"; return 1; }
}
compiles good 'x = select(x > 0, y, x); b = solve(S, b); if (any(x > y)) x = -x; using std::atan2; x += atan2(y, x) *
  (std::atan2(1.0, 2) + std::sqrt(4) + std::abs(-3) + std::pow(2, 3)) + b.norm(); Eigen::Matrix<Real, 70, 70> large;' ||
  { cat "$work/good.log"; exit 1; }

# A world, the lines of which NAME=LINE replaces.
world() {
  local run='static void run(const Settings&, OwnTrial& trial)' keys='OwnKeys<Settings>& keys' more=
  [ $# -eq 0 ] || local "$@"
  printf '%s\n' '}' 'struct W { struct Settings { double a = 1; };' "$more" 'static constexpr const char* name = "w";' \
    "static void keys($keys) { keys.real(\"a.b\", &Settings::a, 0, 1, \"a\"); }" \
    'static std::vector<Component> components(const Settings&) { return {{"x", "m"}, {"y", "m"}}; }' \
    'static std::vector<ComponentGroup> groups(const Settings&) { return {}; }' \
    'static std::vector<std::string> arms(const Settings&) { return {"kf"}; }' \
    'static int innovation_rows(const Settings&) { return 0; }' \
    "$run { trial.step(trial.normal(0, 1), Eigen::Matrix2d::Identity()); } };" \
    'Real last(Real x, Real y, Eigen::Matrix<Real, 5, 5> S, Eigen::Matrix<Real, 5, 1> b) { add_own_world<W>();'
}
compiles world "return x; $(world)" || { cat "$work/world.log"; exit 1; }

mask='write select(mask, yes, no)'
std='write credence::sqrt, sin, cos, atan2'
cases=(
  "atan2|$std|y = std::atan2(y, x);"
  "sqrt|$std|y = std::sqrt(S(0, 0));"
  "pow|$std|y = std::pow(x, 2);"
  "isnan|$std|if (std::isnan(b(0))) y = x;"
  "max|$mask|y = std::max(x, y);"
  "run|a world has static run(const Settings&, OwnTrial&)|return x; $(world run='static void run(Settings& s, OwnTrial& trial)')"
  "lanes|a world has static run(const Settings&, OwnTrial&)|return x; $(world run='template <class T> static void run(Settings& s, OwnTrialOf<T>& trial)')"
  "keys|adds to the list that it is given, not to a copy|return x; $(world keys='OwnKeys<Settings> keys')"
  "columns|takes settings that are const, and gives a vector of Column|return x; $(world more='static std::vector<Column> columns(Settings&) { return {}; }')"
  "validate|takes settings that are const|return x; $(world more='static void validate(Settings&) {}')"
  "if|$mask|if (x > 0) y = x;"
  "and|both, either and negated for|if (any(x > 0 && y > 0)) y = x;"
  "not|$mask|while (!(x > 0)) x += 1;"
  "conditional|$mask|y = x > y ? x : y;"
  "real|$mask|if (x) y = x;"
  "llt|of a covariance S, write credence::cholesky(S), solve(S, b)|b = S.llt().solve(b);"
  "ldlt|of a covariance S, write credence::cholesky(S), solve(S, b)|b = S.ldlt().solve(b);"
  "lu|of a covariance S, write credence::cholesky(S), solve(S, b)|b = S.lu().solve(b);"
  "inverse|of a covariance S, write credence::cholesky(S), solve(S, b)|S = S.inverse().eval();"
  "qr|of a covariance S, write credence::cholesky(S), solve(S, b)|b = S.colPivHouseholderQr().solve(b);"
  "eigenvalues|for a square root of a covariance, write credence::cholesky(P).L|Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Real, 5, 5>> solver(S);"
  "svd|for a square root of a covariance, write credence::cholesky(P).L|Eigen::JacobiSVD<Eigen::Matrix<Real, 5, 5>> solver(S);")
failures=0
for one in "${cases[@]}"; do
  IFS='|' read -r -d '' name sentence code <<<"$one" || true
  refused "$name" "$sentence" "$code" &
done
for job in $(jobs -p); do wait "$job" || failures=$((failures + 1)); done
[ $failures -eq 0 ] || { echo "$failures of ${#cases[@]} failed"; exit 1; }
echo "${#cases[@]} mistakes, each with its sentence"
