#pragma once
// Module worlds: Cholesky factors, solutions, inverses and determinants of small symmetric positive definite matrices,
// without branches: for doubles and for packs the same operations in the same order. Of a matrix that is not positive
// definite they are NaN in its lane. Matrices have a size, or a largest size, that the compiler knows.

#include <credence/detail/eigen_lanes.hpp>

#include <type_traits>
#include <utility>

namespace credence {
inline namespace CREDENCE_TARGET {

/// S = L L', L lower triangular.
template <class Matrix>
struct Cholesky {
    using Real = typename Matrix::Scalar;
    using Index = Eigen::Index;
    /// A matrix of Reals of B's size; B may be one of doubles.
    template <class B>
    using Like = typename std::remove_cvref_t<decltype(std::declval<const B&>().template cast<Real>())>::PlainObject;

    Matrix L;                                                                ///< [n, n], 0 above the diagonal
    Eigen::Matrix<Real, Matrix::RowsAtCompileTime, 1, 0, Matrix::MaxRowsAtCompileTime, 1> reciprocal;  ///< 1 / L_ii
    Mask<Real> positive_definite = all_lanes<Real>();

    /// L^-1 B
    template <class B>
    Like<B> whitened(const Eigen::MatrixBase<B>& right) const {
        Like<B> X = right.template cast<Real>();
        for (Index c = 0; c < X.cols(); ++c)
            for (Index i = 0; i < L.rows(); ++i) {
                for (Index k = 0; k < i; ++k) X(i, c) = fnma(L(i, k), X(k, c), X(i, c));
                X(i, c) *= reciprocal(i);
            }
        return X;
    }
    /// S^-1 B
    template <class B>
    Like<B> solve(const Eigen::MatrixBase<B>& right) const {
        Like<B> X = whitened(right);
        for (Index c = 0; c < X.cols(); ++c)
            for (Index i = L.rows() - 1; i >= 0; --i) {
                for (Index k = i + 1; k < L.rows(); ++k) X(i, c) = fnma(L(k, i), X(k, c), X(i, c));
                X(i, c) *= reciprocal(i);
            }
        return X;
    }
    /// S^-1, symmetric to the last bit.
    Matrix inverse() const {
        Matrix root(L.rows(), L.cols()), result(L.rows(), L.cols());  // L^-1, of which the lower triangle is there
        for (Index c = 0; c < L.cols(); ++c)
            for (Index i = c; i < L.rows(); ++i) {
                Real entry = Real(i == c ? 1 : 0);
                for (Index k = c; k < i; ++k) entry = fnma(L(i, k), root(k, c), entry);
                root(i, c) = entry * reciprocal(i);
            }
        for (Index i = 0; i < L.rows(); ++i)
            for (Index j = 0; j <= i; ++j) {
                Real sum = root(i, i) * root(i, j);
                for (Index k = i + 1; k < L.rows(); ++k) sum = fma(root(k, i), root(k, j), sum);
                result(i, j) = result(j, i) = sum;
            }
        return result;
    }
    Real determinant() const {
        Real product = L(0, 0);
        for (Index i = 1; i < L.rows(); ++i) product *= L(i, i);
        return product * product;
    }
};

/// The factor of S, of which the lower triangle is read.
template <class Derived>
auto cholesky(const Eigen::MatrixBase<Derived>& S) {
    using Matrix = typename Derived::PlainObject;
    using Real = typename Matrix::Scalar;
    Cholesky<Matrix> factor;
    factor.L = S;
    factor.reciprocal.resize(S.rows());
    Matrix& L = factor.L;
    for (Eigen::Index j = 0; j < L.cols(); ++j) {
        for (Eigen::Index i = j; i < L.rows(); ++i) {
            Real entry = L(i, j);
            for (Eigen::Index k = 0; k < j; ++k) entry = fnma(L(i, k), L(j, k), entry);
            L(i, j) = entry;
        }
        factor.positive_definite = both(factor.positive_definite, L(j, j) > Real(0));
        L(j, j) = sqrt(L(j, j));
        factor.reciprocal(j) = Real(1) / L(j, j);
        for (Eigen::Index i = j + 1; i < L.rows(); ++i) {
            L(i, j) *= factor.reciprocal(j);
            L(j, i) = Real(0);
        }
    }
    return factor;
}

/// S^-1 B
template <class Derived, class B>
auto solve(const Eigen::MatrixBase<Derived>& S, const Eigen::MatrixBase<B>& right) { return cholesky(S).solve(right); }
/// S^-1
template <class Derived>
auto inverse(const Eigen::MatrixBase<Derived>& S) { return cholesky(S).inverse(); }
template <class Derived>
auto determinant(const Eigen::MatrixBase<Derived>& S) { return cholesky(S).determinant(); }

}  // namespace CREDENCE_TARGET
}  // namespace credence
