#pragma once
// Dense matrices in 50 decimal digits, for where doubles have lost theirs.

#include <Eigen/Dense>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <random>

namespace credence::test {

using Fifty = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using FiftyMatrix = Eigen::Matrix<Fifty, Eigen::Dynamic, Eigen::Dynamic>;
using FiftyVector = Eigen::Matrix<Fifty, Eigen::Dynamic, 1>;

/// Standard-normal numbers.
inline FiftyMatrix drawn_normal(std::mt19937_64& random, int rows, int columns) {
    std::normal_distribution<double> normal;
    return FiftyMatrix::NullaryExpr(rows, columns, [&] { return Fifty(normal(random)); });
}

/// A covariance [n, n] with eigenvalues from 1 down to 1/condition, at even distances of their logarithms, in axes drawn
/// at random.
inline FiftyMatrix conditioned(std::mt19937_64& random, int n, double condition) {
    const FiftyMatrix Q = drawn_normal(random, n, n).householderQr().householderQ();
    FiftyVector values(n);
    for (int i = 0; i < n; ++i) values[i] = pow(Fifty(condition), Fifty(-i) / (n - 1));
    return Q * values.asDiagonal() * Q.transpose();
}

/// L, P = L L'.
inline FiftyMatrix lower_factor(const FiftyMatrix& P) { return P.llt().matrixL(); }

/// e'P^-1e
inline Fifty squared_error(const FiftyMatrix& P, const FiftyVector& e) { return e.dot(P.llt().solve(e)); }

}  // namespace credence::test
