#pragma once
// Module worlds: the unscented transform and update, for doubles and for packs.

#include <credence/detail/updates.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// Van der Merwe's parameters of the sigma points 0, +-sqrt(n + lambda) L e_i, P = L L', lambda = alpha^2 (n + kappa)
/// - n [van der Merwe 2004, 3.2]. alpha is how far the points spread, beta = 2 is best for normal errors.
struct SigmaPoints {
    double alpha = 1, beta = 2, kappa = 0;

    double scale(int n) const { return alpha * alpha * (n + kappa); }                      ///< n + lambda
    double mean_weight(int n) const { return 1 - n / scale(n); }                           ///< of the middle point
    double covariance_weight(int n) const { return mean_weight(n) + 1 - alpha * alpha + beta; }
    double weight(int n) const { return 1 / (2 * scale(n)); }                              ///< of each other point
};

/// A random vector y of which a state's error is the cause.
template <class Real, int n, int m>
struct Transformed {
    Eigen::Matrix<Real, m, 1> mean;
    Eigen::Matrix<Real, m, m> covariance;
    Eigen::Matrix<Real, n, m> cross;  ///< of the error with y
};

/// a - b, for vectors without angles.
struct PlainDifference {
    template <class A, class B>
    auto operator()(const A& a, const B& b) const { return (a - b).eval(); }
};

/// Mean and covariance of y = f(d), d ~ N(0, P): `function` takes a step d [n] from the estimate and gives y [m].
/// `difference` (a, b) is a - b with angles wrapped; the mean is taken of differences to the middle point's y, and is
/// not wrapped again.
template <class DerivedP, class Function, class Difference = PlainDifference>
auto unscented_transform(const Eigen::MatrixBase<DerivedP>& P, const SigmaPoints& points, Function function,
                         Difference difference = {}) {
    using Real = typename DerivedP::Scalar;
    constexpr int n = DerivedP::RowsAtCompileTime;
    using State = Eigen::Matrix<Real, n, 1>;
    using Y = typename std::remove_cvref_t<decltype(function(State()))>::PlainObject;
    constexpr int m = Y::RowsAtCompileTime;
    const double spread = __builtin_sqrt(points.scale(n)), weight = points.weight(n);
    const Eigen::Matrix<Real, n, n> L = cholesky(P).L * Real(spread);
    const Y middle = function(State(State::Zero()));
    Eigen::Matrix<Real, m, n> plus, minus;  // differences to the middle's y
    Y mean = Y::Zero();
    for (int i = 0; i < n; ++i) {
        plus.col(i) = difference(function(State(L.col(i))), middle);
        minus.col(i) = difference(function(State(-L.col(i))), middle);
        mean += Real(weight) * (plus.col(i) + minus.col(i));
    }
    Transformed<Real, n, m> result;
    result.mean = middle + mean;
    result.covariance = Real(points.covariance_weight(n)) * mean * mean.transpose();
    result.cross.setZero();
    for (int i = 0; i < n; ++i) {
        result.cross += Real(weight) * L.col(i) * (plus.col(i) - minus.col(i)).transpose();
        const Y up = plus.col(i) - mean, down = minus.col(i) - mean;
        result.covariance += Real(weight) * (up * up.transpose() + down * down.transpose());
    }
    return result;
}

/// The update by a measurement z whose distribution, without its noise R, is `predicted`: K = cross S^-1,
/// P^+ = P - K S K'. [Julier, Uhlmann 2004]
template <class DerivedP, class Real, int n, int m, class DerivedZ, class DerivedR, class Difference = PlainDifference>
Updated<Real, n, m> unscented_update(const Eigen::MatrixBase<DerivedP>& P, const Transformed<Real, n, m>& predicted,
                                     const Eigen::MatrixBase<DerivedZ>& z, const Eigen::MatrixBase<DerivedR>& R,
                                     Difference difference = {}) {
    Updated<Real, n, m> result;
    result.innovation = difference(z, predicted.mean);
    result.S = predicted.covariance + R;
    const Eigen::Matrix<Real, m, n> half = cholesky(result.S).whitened(predicted.cross.transpose());
    result.step = half.transpose() * cholesky(result.S).whitened(result.innovation);
    result.P = symmetric_sum(-half.transpose(), half.transpose(), P);
    return result;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
