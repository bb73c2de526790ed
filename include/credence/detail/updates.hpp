#pragma once
// Module worlds: predictions and updates of Kalman filters, for doubles and for packs.
//
//   P  covariance of the state's error [n, n]    nu  innovation [m]    H  its Jacobian [m, n]    R  its noise [m, m]
//
// An update gives a step: x^+ = x^- + step, or on a manifold x^- [+] step in the chart in which P is given. Covariances
// are symmetric to the last bit.

#include <credence/detail/symmetric.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// What an update gives. For steps that only some trials measure: select(seen, update.step, 0), select(seen, update.P,
/// P).
template <class Real, int n, int m>
struct Updated {
    Eigen::Matrix<Real, n, 1> step;
    Eigen::Matrix<Real, n, n> P;
    Eigen::Matrix<Real, m, 1> innovation;
    Eigen::Matrix<Real, m, m> S;  ///< covariance of the innovation
};

/// a b + c: of packs rounded once, of doubles as the processor does it fastest.
inline double multiply_add(double a, double b, double c) { return a * b + c; }
template <int W, class A, class B>
Lane<W> multiply_add(A a, B b, Lane<W> c) { return fma(Lane<W>(a), Lane<W>(b), c); }

/// A B' + start, column by column: what a column adds up to stays in registers.
template <class Start, class A, class B>
auto product_sum(const Eigen::MatrixBase<A>& left, const Eigen::MatrixBase<B>& right,
                 const Eigen::MatrixBase<Start>& start) {
    using Real = typename Eigen::ScalarBinaryOpTraits<typename A::Scalar, typename B::Scalar>::ReturnType;
    constexpr int n = A::RowsAtCompileTime, m = B::RowsAtCompileTime, inner = A::ColsAtCompileTime;
    static_assert(n > 0 && m > 0 && inner > 0, "filters take matrices of sizes that the compiler knows");
    Eigen::Matrix<Real, n, m> result;
    for (int j = 0; j < m; ++j) {
        Real column[n];
        for (int i = 0; i < n; ++i) column[i] = Real(start(i, j));
        for (int k = 0; k < inner; ++k) {
            const auto factor = right(j, k);
            for (int i = 0; i < n; ++i) column[i] = multiply_add(left(i, k), factor, column[i]);
        }
        for (int i = 0; i < n; ++i) result(i, j) = column[i];
    }
    return result;
}

/// A B' + start where that is known to be symmetric: symmetric to the last bit, by its lower triangle.
template <class Start, class A, class B>
auto symmetric_sum(const Eigen::MatrixBase<A>& left, const Eigen::MatrixBase<B>& right,
                   const Eigen::MatrixBase<Start>& start) {
    auto result = product_sum(left, right, start);
    for (Eigen::Index j = 1; j < result.cols(); ++j)
        for (Eigen::Index i = 0; i < j; ++i) result(i, j) = result(j, i);
    return result;
}

/// F P F' + Q, P symmetric. F and Q may be of doubles.
template <class DerivedF, class DerivedP, class DerivedQ>
auto predicted_covariance(const Eigen::MatrixBase<DerivedF>& F, const Eigen::MatrixBase<DerivedP>& P,
                          const Eigen::MatrixBase<DerivedQ>& Q) {
    constexpr int n = DerivedF::RowsAtCompileTime, inner = DerivedF::ColsAtCompileTime;
    const typename DerivedF::PlainObject by = F;
    return symmetric_sum(product_sum(by, P.derived(), Eigen::Matrix<double, n, inner>::Zero()), by, Q);
}
/// The same without noise: the covariance of F x.
template <class DerivedF, class DerivedP>
auto predicted_covariance(const Eigen::MatrixBase<DerivedF>& F, const Eigen::MatrixBase<DerivedP>& P) {
    constexpr int n = DerivedF::RowsAtCompileTime;
    return predicted_covariance(F, P, Eigen::Matrix<double, n, n>::Zero());
}

/// The joint update: K = P H' S^-1, S = H P H' + R, and Joseph's form P^+ = (I - K H) P (I - K H)' + K R K', which is
/// the covariance of any gain. [Bar-Shalom, Li, Kirubarajan 2001, 5.2.3]
template <class DerivedP, class DerivedH, class DerivedR, class Innovation>
auto kalman_update(const Eigen::MatrixBase<DerivedP>& P, const Eigen::MatrixBase<Innovation>& innovation,
                   const Eigen::MatrixBase<DerivedH>& H, const Eigen::MatrixBase<DerivedR>& R) {
    using Real = typename DerivedP::Scalar;
    constexpr int n = DerivedP::RowsAtCompileTime, m = DerivedH::RowsAtCompileTime;
    Updated<Real, n, m> result;
    const Eigen::Matrix<Real, n, m> cross = product_sum(P, H, Eigen::Matrix<double, n, m>::Zero());
    result.innovation = innovation;
    result.S = symmetric_sum(H, cross.transpose(), R);
    const Eigen::Matrix<Real, n, m> K = cholesky(result.S).solve(cross.transpose()).transpose();
    result.step = K * result.innovation;
    const Eigen::Matrix<Real, n, n> kept = product_sum(-K, H.transpose(), Eigen::Matrix<double, n, n>::Identity());
    const Eigen::Matrix<Real, n, m> noise = product_sum(K, R, Eigen::Matrix<double, n, m>::Zero());
    result.P = symmetric_sum(noise, K, predicted_covariance(kept, P));
    return result;
}

/// The same update for independent noises, variances [m], one row after the other: no inverse, and about a third of the
/// operations where n is much larger than m. P^+ = P - k s k', symmetric, but not safe where P is nearly singular.
template <class DerivedP, class DerivedH, class DerivedR, class Innovation>
auto sequential_update(const Eigen::MatrixBase<DerivedP>& P, const Eigen::MatrixBase<Innovation>& innovation,
                       const Eigen::MatrixBase<DerivedH>& H, const Eigen::MatrixBase<DerivedR>& variances) {
    using Real = typename DerivedP::Scalar;
    constexpr int n = DerivedP::RowsAtCompileTime, m = DerivedH::RowsAtCompileTime;
    static_assert(DerivedR::ColsAtCompileTime == 1, "sequential_update takes the variances of independent noises, [m]");
    Updated<Real, n, m> result;
    result.innovation = innovation;
    const Eigen::Matrix<Real, n, m> all = product_sum(P, H, Eigen::Matrix<double, n, m>::Zero());
    result.S = symmetric_sum(H, all.transpose(), Eigen::Matrix<double, m, m>::Zero());
    result.S.diagonal() += variances;
    result.step.setZero();
    result.P = P;
    for (Eigen::Index row = 0; row < m; ++row) {
        const Eigen::Matrix<Real, n, 1> cross = result.P * H.row(row).transpose();
        const Eigen::Matrix<Real, n, 1> k = cross / (H.row(row) * cross + variances.row(row)).value();
        result.step += k * (result.innovation.row(row) - H.row(row) * result.step);
        for (Eigen::Index j = 0; j < n; ++j)
            for (Eigen::Index i = j; i < n; ++i)
                result.P(i, j) = result.P(j, i) = multiply_add(-k(i), cross(j), result.P(i, j));
    }
    return result;
}

/// A measurement about x [+] step.
template <class Real, int n, int m>
struct Linearised {
    Eigen::Matrix<Real, m, 1> innovation;  ///< z - h(x [+] step), angles wrapped
    Eigen::Matrix<Real, m, n> H;           ///< dh(x [+] step)/dstep
};

/// The iterated update of Bell and Cathey [1993], which is Gauss-Newton's way to the most probable state: `linearise`
/// gives the measurement about a step [n], from 0 on, `passes` times; one pass is the extended update. Innovation and S
/// are those of the first pass.
template <class DerivedP, class DerivedR, class Linearise>
auto iterated_update(const Eigen::MatrixBase<DerivedP>& P, const Eigen::MatrixBase<DerivedR>& R, int passes,
                     Linearise linearise) {
    using Real = typename DerivedP::Scalar;
    constexpr int n = DerivedP::RowsAtCompileTime, m = DerivedR::RowsAtCompileTime;
    Eigen::Matrix<Real, n, 1> step = Eigen::Matrix<Real, n, 1>::Zero();
    const Linearised<Real, n, m> first = linearise(step);
    Updated<Real, n, m> result = kalman_update(P, first.innovation, first.H, R);
    for (int pass = 1; pass < passes; ++pass) {
        step = result.step;
        const Linearised<Real, n, m> about = linearise(step);
        Updated<Real, n, m> next = kalman_update(P, about.innovation + about.H * step, about.H, R);
        result.step = next.step;
        result.P = next.P;
    }
    return result;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
