#!/usr/bin/env bash
# What lanes cannot do fails to compile, with a sentence that says what to write instead.
#   lanes_refused_test.sh SOURCE_FOLDER CXX EIGEN_FOLDER
set -euo pipefail
source=$1 cxx=$2 eigen=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# compiles NAME CODE: whether a filter with this line compiles; its messages are in NAME.log.
compiles() {
  printf '%s\n' '#include <credence/own_trial.hpp>' 'using namespace credence; using Real = Lane<4>;' \
    'Real filter(Real x, Real y, Eigen::Matrix<Real, 5, 5> S, Eigen::Matrix<Real, 5, 1> b) {' "$2" \
    'return x + y + S(0) + b(0); }' >"$work/$1.cpp"
  "$cxx" -std=c++20 -fsyntax-only -w -I"$source/include" -isystem "$eigen" "$work/$1.cpp" >"$work/$1.log" 2>&1
}
# refused NAME SENTENCE CODE
refused() {
  if compiles "$1" "$3"; then echo "$1: compiles: $3"; return 1; fi
  grep -q "error: .*$2" "$work/$1.log" || { echo "$1: not the sentence of $3"; head -n 20 "$work/$1.log"; return 1; }
}
compiles good 'x = select(x > 0, y, x); b = solve(S, b); if (any(x > y)) x = -x;' || { cat "$work/good.log"; exit 1; }

mask='write select(mask, yes, no)'
cases=(
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
  IFS='|' read -r name sentence code <<<"$one"
  refused "$name" "$sentence" "$code" &
done
for job in $(jobs -p); do wait "$job" || failures=$((failures + 1)); done
[ $failures -eq 0 ] || { echo "$failures of ${#cases[@]} failed"; exit 1; }
echo "${#cases[@]} mistakes, each with its sentence"
