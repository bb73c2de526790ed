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

/// A covariance [n, n] with eigenvalues from 1 down to 1/condition, at even distances of their logarithms, in axes
/// drawn at random.
inline FiftyMatrix conditioned(std::mt19937_64& random, int n, double condition) {
    const FiftyMatrix Q = drawn_normal(random, n, n).householderQr().householderQ();
    FiftyVector values(n);
    for (int i = 0; i < n; ++i) values[i] = pow(Fifty(condition), Fifty(-i) / (n - 1));
    return Q * values.asDiagonal() * Q.transpose();
}

/// A covariance [n, n] of numbers, and from component `first` on of the x and y of points, which know of each other
/// 1/condition of the variance with which they know where they are.
inline FiftyMatrix known_together(std::mt19937_64& random, int n, int first, double condition) {
    FiftyMatrix P = conditioned(random, n, 10) / Fifty(condition);
    for (int i = first; i < n; ++i)
        for (int j = first + (i - first) % 2; j < n; j += 2) P(i, j) += 1;
    return P;
}

/// P in doubles, symmetric.
inline Eigen::MatrixXd rounded(const FiftyMatrix& P) {
    return Eigen::MatrixXd(P.cast<double>().selfadjointView<Eigen::Lower>());
}

/// L, P = L L'.
inline FiftyMatrix lower_factor(const FiftyMatrix& P) { return P.llt().matrixL(); }

/// e'P^-1e
inline Fifty squared_error(const FiftyMatrix& P, const FiftyVector& e) { return e.dot(P.llt().solve(e)); }

/// Greatest absolute eigenvalue of a symmetric matrix.
inline double largest_eigenvalue(const FiftyMatrix& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric.cast<double>(), Eigen::EigenvaluesOnly)
        .eigenvalues().cwiseAbs().maxCoeff();
}

/// |P^-1|
inline double largest_of_inverse(const FiftyMatrix& P) {
    return largest_eigenvalue(P.llt().solve(FiftyMatrix::Identity(P.rows(), P.cols())));
}

/// |L^-1 (P^ - P) L'^-1|, P = L L': the greatest relative error that P^ in place of P can make of a NEES.
inline double relative_error(const Eigen::MatrixXd& in_doubles, const FiftyMatrix& P) {
    const FiftyMatrix L = lower_factor(P);
    const FiftyMatrix half = L.triangularView<Eigen::Lower>().solve(in_doubles.cast<Fifty>() - P);
    return largest_eigenvalue(L.triangularView<Eigen::Lower>().solve(FiftyMatrix(half.transpose())));
}

}  // namespace credence::test
