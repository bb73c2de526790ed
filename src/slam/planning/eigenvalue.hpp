#pragma once
// The largest eigenvalue of a covariance, sooner than criterion.hpp's plain form
// [docs/theory/model.md, Largest eigenvalue].
//
//   A  W^1/2 P W^1/2, n rows; of one axis where P = P_1 (x) I_2
// Laguerre's iteration for the roots of det(lambda I - A) from above never passes the largest one, since all are real
// [Wilkinson 1965: The Algebraic Eigenvalue Problem, 7.28]; the traces of R = (lambda I - A)^-1 and of R^2 are its
// derivatives. R's largest column tends to the eigenvector.

#include "slam/planning/controller.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Rows of A.
template <class Layout>
constexpr auto eigenvalue_rows(const Layout& layout) {
    if constexpr (Layout::by_axis)
        return half(layout.size());
    else
        return layout.size();
}

/// A_ij, i <= j.
template <class Layout, class Real, int capacity>
CREDENCE_INLINE Real weighted_entry(const Symmetric<Real, capacity>& P, const Layout&, double root_of_heading, auto i,
                                    auto j) {
    if constexpr (Layout::by_axis)
        return P.entry[two * i][two * j];
    else if (i < Layout::position)
        return Real(root_of_heading * (j < Layout::position ? root_of_heading : 1)) * P.entry[i][j];
    else
        return P.entry[i][j];
}

/// Above every eigenvalue: the root of the sum of A's squared entries.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Real above_eigenvalues(const Symmetric<Real, capacity>& P, const Layout& layout,
                                     const Weights& weights) {
    const auto n = eigenvalue_rows(layout);
    const double root = __builtin_sqrt(weights.heading);
    const Real scale = Real(1) / weighted_trace(P, layout, weights);  // a square may underflow
    Real half_squares = Real(0);
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
        each(i, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
            const Real entry = scale * weighted_entry(P, layout, root, i, j);
            half_squares = fma(Real(i == j ? 0.5 : 1) * entry, entry, half_squares);
        });
    });
    return Real(1 + 1e-12) * sqrt(Real(2) * half_squares) / scale;
}

/// The largest eigenvalue, to some 10^-15 of it, and its eigenvector x [rows of A], in the lanes `wanted` from a `high`
/// above it, which above_eigenvalues() is not below: farther up R's traces tell nothing but `high`. `R` is workspace.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Real largest_eigenvalue_below(Real high, Mask<Real> wanted, const Symmetric<Real, capacity>& P,
                                            const Weights& weights, const Layout& layout,
                                            Symmetric<Real, capacity>& R, Real* x) {
    constexpr int most = 40;  // fewer than ten are needed
    const auto n = eigenvalue_rows(layout);
    const Real count = Real(static_cast<int>(n));
    const double root = __builtin_sqrt(weights.heading);
    const Mask<Real> all = all_lanes<Real>();
    Mask<Real> moving = wanted;
    for (int turn = 0; turn < most && any(moving); ++turn) {
        each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
            each(i, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
                R.entry[i][j] = (i == j ? high : Real(0)) - weighted_entry(P, layout, root, i, j);
            });
        });
        each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA { moving = both(moving, sweep(R, n, i, all) > Real(0)); });
        Real trace = Real(0), half_squares = Real(0);  // of -R
        each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
            trace = trace - R.entry[i][i];
            half_squares = fma(Real(0.5) * R.entry[i][i], R.entry[i][i], half_squares);
            each(i + one, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
                half_squares = fma(R.entry[i][j], R.entry[i][j], half_squares);
            });
        });
        const Real spread = (count - Real(1)) * fnma(trace, trace, Real(2) * count * half_squares);
        const Real step = count / (trace + sqrt(select(spread > Real(0), spread, Real(0))));
        high = select(moving, high - step, high);
        moving = both(moving, step > Real(1e-15) * high);
    }
    Real largest = Real(0), scale = Real(0);
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
        const Real size = absolute(R.entry[i][i]);
        const Mask<Real> larger = both(wanted, size > largest);
        largest = select(larger, size, largest);
        scale = select(larger, Real(1) / size, scale);
        each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { x[k] = select(larger, R.at(i, k), x[k]); });
    });
    each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { x[k] = select(scale > Real(0), scale * x[k], x[k]); });
    return high;
}

/// x' A x / x' x
template <class Layout, class Real, int capacity>
CREDENCE_INLINE Real value_along(const Real* x, const Symmetric<Real, capacity>& P, const Layout& layout,
                                 const Weights& weights) {
    const auto n = eigenvalue_rows(layout);
    const double root = __builtin_sqrt(weights.heading);
    Real form = Real(0), squares = Real(0);
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
        Real sum = Real(0.5) * weighted_entry(P, layout, root, i, i) * x[i];
        each(i + one, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
            sum = fma(weighted_entry(P, layout, root, i, j), x[j], sum);
        });
        form = fma(Real(2) * sum, x[i], form);
        squares = fma(x[i], x[i], squares);
    });
    return form / squares;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
