#pragma once
// The largest eigenvalue of a covariance, sooner than criterion.hpp's plain form
// [docs/theory/model.md, Largest eigenvalue].
//
//   A  W^1/2 P W^1/2, n rows; of one axis where P = P_1 (x) I_2
// Laguerre's iteration for the roots of det(lambda I - A) from above never passes the largest one, since all are real
// [Wilkinson 1965: The Algebraic Eigenvalue Problem, 7.28]; the traces of R = (lambda I - A)^-1 and of R^2 are its
// derivatives. R's largest column tends to the eigenvector.
// Along any x, y = W^1/2 x, the eigenvalue is at least y'P+y / x'x, which is convex in the sightings' v_j as the trace
// is in screening.hpp, whose symbols are used here.

#include "slam/planning/screening.hpp"

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
CREDENCE_FLAT Real above_eigenvalues(const Symmetric<Real, capacity>& P, const Layout& layout, const Weights& weights) {
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

/// R's largest column, divided by its diagonal entry, in the lanes `wanted`.
template <class Real, int capacity, class Size>
CREDENCE_INLINE void find_eigenvector(const Symmetric<Real, capacity>& R, Size n, Mask<Real> wanted, Real* x) {
    Real largest = Real(0);
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
        const Real size = absolute(R.entry[i][i]);
        const Mask<Real> larger = both(wanted, size > largest);
        largest = select(larger, size, largest);
        each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { x[k] = select(larger, R.at(i, k), x[k]); });
    });
    const Real scale = select(largest > Real(0), Real(1) / largest, Real(1));
    each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA { x[k] = scale * x[k]; });
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
    Real last = Real(0);  // step
    for (int turn = 0; turn < most && any(moving); ++turn) {
        each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
            each(i, n, [&](auto j) CREDENCE_INLINE_LAMBDA {
                R.entry[i][j] = (i == j ? high : Real(0)) - weighted_entry(P, layout, root, i, j);
            });
        });
        each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA { moving = both(moving, sweep(R, n, i, all) > Real(0)); });
        find_eigenvector(R, n, moving, x);  // where high has met the eigenvalue, R is of no use
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
        // Steps fall with the third power at last: the next one is about this one's times the third power of its ratio
        // to the one before.
        const Real ratio = step / last;
        moving = both(moving, step * smaller(ratio * ratio * ratio, Real(1)) > Real(1e-16) * high);
        last = step;
    }
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
        each(i + one, n,
             [&](auto j) CREDENCE_INLINE_LAMBDA { sum = fma(weighted_entry(P, layout, root, i, j), x[j], sum); });
        form = fma(Real(2) * sum, x[i], form);
        squares = fma(x[i], x[i], squares);
    });
    return form / squares;
}

/// The tangent of y'P+y / x'x at a reference, without the fresh heading noise: T' y = y + s e_theta, s = y_r . a.
template <class Layout, class Real>
struct EigenvalueTangent {
    /// constant + s linear + s^2 quadratic
    struct Polynomial {
        Real constant, linear, quadratic;
    };
    Vector2<Real> turn;                             ///< s is turn . v, v the move in the body frame
    Polynomial rest;                                ///< the part that does not depend on any v_j
    Polynomial slope[Layout::feature_capacity];     ///< its fall with v_j

    /// The lower bound on the eigenvalue of a candidate whose v_j are value(j).
    template <class Value>
    Real bound(const Point& move, const Layout& layout, const Value& value) const {
        Real s{};
        if constexpr (Layout::has_heading) s = fma(Real(move.x), turn.x, Real(move.y) * turn.y);
        const auto at_move = [&](const Polynomial& p) {
            return Layout::has_heading ? fma(s, fma(s, p.quadratic, p.linear), p.constant) : p.constant;
        };
        Real least = at_move(rest);
        each(zero, layout.features(), [&](auto j) { least = fnma(at_move(slope[j]), value(j), least); });
        return least;
    }
};

/// The tangent along x [rows of A] at the reference, whose move is `move` in the world. `still` lacks the robot's fresh
/// noise. `A` is workspace.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void touch_along(const Real* x, const Vector2<Real>& move, const Belief<Real, capacity>& still,
                               const Rotation<Real>& heading, const FilterParameters& filter,
                               const SensorParameters& sensor, const Layout& layout, const Weights& weights,
                               double kappa, Symmetric<Real, capacity>& A, EigenvalueTangent<Layout, Real>& tangent) {
    using Polynomial = typename EigenvalueTangent<Layout, Real>::Polynomial;
    constexpr auto r = Layout::position;
    const auto n = layout.size();
    copy(still.covariance, n, A);
    add_odometry_noise<Layout>(A, filter);
    Real value[Layout::feature_capacity], weight[Layout::feature_capacity], y[capacity], Ay[capacity];
    condition_from(point_at(still.mean, r) + move, still.mean, filter, sensor, layout, kappa, A, value, weight);
    const double root = __builtin_sqrt(weights.heading);
    Real squares = Real(0);
    each(zero, eigenvalue_rows(layout), [&](auto i) CREDENCE_INLINE_LAMBDA {
        squares = fma(x[i], x[i], squares);
        if constexpr (Layout::by_axis)
            y[two * i] = x[i], y[two * i + one] = Real(0);
        else
            y[i] = Real(i < r ? root : 1) * x[i];
    });
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA {
        Ay[i] = Real(0);
        each(zero, n, [&](auto k) CREDENCE_INLINE_LAMBDA {
            if (!Layout::by_axis || (i % 2 == 0 && k % 2 == 0)) Ay[i] = fma(A.at(i, k), y[k], Ay[i]);
        });
    });
    const Real scale = Real(1) / squares;
    Polynomial& rest = tangent.rest;
    rest = {};
    each(zero, n, [&](auto i) CREDENCE_INLINE_LAMBDA { rest.constant = fma(y[i], Ay[i], rest.constant); });
    rest.constant = rest.constant * scale;
    if constexpr (Layout::has_heading) {
        tangent.turn = rotate_back(heading, Vector2<Real>{y[r + one], -y[r]});
        rest.linear = Real(2) * scale * Ay[Layout::heading];
        rest.quadratic = scale * A.entry[Layout::heading][Layout::heading];
    }
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        const auto rows = sighting_rows<Layout>(still.mean, j);
        const Vector2<Real> p = rows([&](auto i) { return Ay[i]; });
        const Real factor = weight[j] * scale;
        Polynomial& slope = tangent.slope[j];
        slope = {factor * squared_norm(p), Real(0), Real(0)};
        if constexpr (Layout::has_heading) {
            const Vector2<Real> q = rows([&](auto i) { return A.at(i, Layout::heading); });
            slope.linear = Real(2) * factor * fma(p.x, q.x, p.y * q.y);
            slope.quadratic = factor * squared_norm(q);
            rest.linear = fma(slope.linear, value[j], rest.linear);
            rest.quadratic = fma(slope.quadratic, value[j], rest.quadratic);
        }
        rest.constant = fma(slope.constant, value[j], rest.constant);
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
