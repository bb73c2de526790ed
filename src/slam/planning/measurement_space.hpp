#pragma once
// A candidate's cost in the space of the measurements [docs/theory/model.md, Measurement space].
//
//   P, u, a, d0, H0, W as in screening.hpp; M sightings of two rows; g_j = (d_y, -d_x), d = d0_j - u: the effect of the
//   fresh heading noise on sighting j; sigma^2 its variance
//   B_j = P H0_j' [n, 2], w_j its row of the heading, A_jl = H0_j B_l, G_jl the sum over the other rows of W B_j' B_l
//   [2, 2]: the same for all candidates of a step; W_t, W_r the weights of heading and position
// trace(W P+) = trace(W T P T') + W_t sigma^2 - trace(S^-1 C), with
//   S_jl = A_jl + sigma^2 g_j g_l' + N_j I (j = l),  C_jl = G_jl + W_t v_j v_l' + w_j c_l' + c_j w_l',
//   v_j = w_j + sigma^2 g_j, c_j = W_r (a . (the position's rows of B_j) + |a|^2 w_j / 2).
// S and C are eliminated together, sighting by sighting.

#include "slam/planning/turned_trace.hpp"

#include <type_traits>

namespace credence {
inline namespace CREDENCE_TARGET {

template <class Real>
struct Matrix2 {
    Real xx, xy, yx, yy;
};

/// a b' added to m.
template <class Real>
Matrix2<Real> add_outer(const Matrix2<Real>& m, const Vector2<Real>& a, const Vector2<Real>& b) {
    return {fma(a.x, b.x, m.xx), fma(a.x, b.y, m.xy), fma(a.y, b.x, m.yx), fma(a.y, b.y, m.yy)};
}

/// m - a b
template <class Real>
Matrix2<Real> less_product(const Matrix2<Real>& m, const Matrix2<Real>& a, const Matrix2<Real>& b) {
    return {fnma(a.xy, b.yx, fnma(a.xx, b.xx, m.xx)), fnma(a.xy, b.yy, fnma(a.xx, b.xy, m.xy)),
            fnma(a.yy, b.yx, fnma(a.yx, b.xx, m.yx)), fnma(a.yy, b.yy, fnma(a.yx, b.xy, m.yy))};
}

template <class Real>
Matrix2<Real> transposed(const Matrix2<Real>& m) { return {m.xx, m.yx, m.xy, m.yy}; }

template <class Real>
Decorrelation<Real> pivot_of(const Matrix2<Real>& S, Mask<Real> used) {
    return decorrelation(S.xx, S.xy, S.yy, used);
}

/// L^-1 m
template <class Real>
Matrix2<Real> decorrelated(const Decorrelation<Real>& S, const Matrix2<Real>& m) {
    const Vector2<Real> x = S({m.xx, m.yx}), y = S({m.xy, m.yy});
    return {x.x, y.x, x.y, y.y};
}

/// L^-1 C L'^-1, C symmetric
template <class Real>
Matrix2<Real> decorrelated_both(const Decorrelation<Real>& S, const Matrix2<Real>& C) {
    const Real xy = fnma(S.slope, C.xx, C.xy);
    return {C.xx, xy, xy, fnma(S.slope, C.xy + xy, C.yy)};
}

/// m' D^-1
template <class Real>
Matrix2<Real> divided(const Matrix2<Real>& m, const Decorrelation<Real>& S) {
    const Vector2<Real> x = S.weighted({m.xx, m.yx}), y = S.weighted({m.xy, m.yy});
    return {x.x, x.y, y.x, y.y};
}

/// trace(D^-1 C)
template <class Real>
Real trace_of_quotient(const Decorrelation<Real>& S, const Matrix2<Real>& C) {
    return fma(C.xx, S.precision.x, C.yy * S.precision.y);
}

template <class Real>
Matrix2<Real> halved(const Matrix2<Real>& m) {
    return {Real(0.5) * m.xx, Real(0.5) * m.xy, Real(0.5) * m.xy, Real(0.5) * m.yy};
}

/// m + N I
template <class Real>
Matrix2<Real> add_noise(const Matrix2<Real>& m, Real N) { return {m.xx + N, m.xy, m.yx, m.yy + N}; }

// In the translation model every 2 x 2 block is a multiple of the identity [docs/theory/model.md, Translation]: one
// number.
template <class Real>
Real less_product(Real m, Real a, Real b) { return fnma(a, b, m); }
template <class Real>
Real transposed(Real m) { return m; }
template <class Real>
Real pivot_of(Real S, Mask<Real> used) { return select(used, Real(1) / S, Real(0)); }
template <class Real>
Real decorrelated(Real, Real m) { return m; }
template <class Real>
Real decorrelated_both(Real, Real C) { return C; }
template <class Real>
Real divided(Real m, Real S_inverse) { return m * S_inverse; }
template <class Real>
Real trace_of_quotient(Real S_inverse, Real C) { return Real(2) * C * S_inverse; }
template <class Real>
Real halved(Real m) { return Real(0.5) * m; }
template <class Real>
Real add_noise(Real m, Real N) { return m + N; }

/// A 2 x 2 submatrix of S or C.
template <class Layout, class Real>
using Block2 = std::conditional_t<Layout::has_heading, Matrix2<Real>, Real>;

template <class Real>
void set_block(Matrix2<Real>& block, const Matrix2<Real>& value) { block = value; }
template <class Real>
void set_block(Real& block, const Matrix2<Real>& value) { block = value.xx; }

/// The quantities that are the same for all candidates of a step.
template <class Layout, class Real>
struct MeasurementSpace {
    static constexpr int capacity = Layout::feature_capacity;
    Vector2<Real> position, feature[capacity];  ///< means
    Block2<Layout, Real> A[capacity][capacity];  ///< j <= l
    Block2<Layout, Real> G[capacity][capacity];  ///< j <= l
    Vector2<Real> w[capacity], x[capacity], y[capacity];  ///< rows of B_j: heading, W_r position
    TurnedTrace<Real> prior;                    ///< trace(W T P T') + W_t sigma^2
    Weights weights;
    Vector2<Real> B[capacity][Layout::capacity];
};

/// Workspace for one candidate.
template <class Layout, class Real>
struct MeasurementElimination {
    static constexpr int capacity = Layout::feature_capacity;
    Block2<Layout, Real> S[capacity][capacity], C[capacity][capacity];
    Vector2<Real> g[capacity], v[capacity], c[capacity];
    Mask<Real> seen[capacity];
};

/// Computes the shared quantities from a belief whose P includes all of the step's noise but the heading's and the
/// sightings'.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void enter_measurement_space(const Belief<Real, capacity>& still, const FilterParameters& filter,
                                           const Layout& layout, const Weights& weights,
                                           MeasurementSpace<Layout, Real>& space) {
    const auto n = layout.size();
    const auto M = layout.features();
    space.position = point_at(still.mean, Layout::position);
    space.weights = weights;
    space.prior = turned_trace(still.covariance, layout, weights);
    if constexpr (Layout::has_heading)
        space.prior.constant = space.prior.constant + Real(weights.heading * filter.variance_heading);
    each(zero, M, [&](auto j) {
        const auto rows = sighting_rows<Layout>(still.mean, j);
        space.feature[j] = point_at(still.mean, Layout::feature(j));
        each(zero, n, [&](auto i) { space.B[j][i] = rows([&](auto s) { return still.covariance.at(i, s); }); });
        if constexpr (Layout::has_heading) space.w[j] = space.B[j][Layout::heading];
        space.x[j] = scaled(Real(weights.position), space.B[j][Layout::position]);
        space.y[j] = scaled(Real(weights.position), space.B[j][Layout::position + one]);
    });
    each(zero, M, [&](auto j) {
        const auto rows = sighting_rows<Layout>(still.mean, j);
        each(j, M, [&](auto l) {
            const Vector2<Real> x = rows([&](auto s) { return space.B[l][s].x; });
            const Vector2<Real> y = rows([&](auto s) { return space.B[l][s].y; });
            set_block(space.A[j][l], Matrix2<Real>{x.x, y.x, x.y, y.y});
            Matrix2<Real> sum{Real(0), Real(0), Real(0), Real(0)};
            each(Layout::position, n, [&](auto i) {
                sum = add_outer(sum, scaled(Real(weight_at<Layout>(weights, i)), space.B[j][i]), space.B[l][i]);
            });
            set_block(space.G[j][l], sum);
        });
    });
}

/// Gates a candidate and computes its S and C. Sightings that no lane sees are skipped.
template <class Layout, class Real>
CREDENCE_INLINE void form_candidate(const MeasurementSpace<Layout, Real>& space, const Vector2<Real>& u,
                                    const FilterParameters& filter, const SensorParameters& sensor,
                                    const Layout& layout, MeasurementElimination<Layout, Real>& work) {
    const Vector2<Real> a{-u.y, u.x}, there = space.position + u;
    const Real half_squared = Real(0.5 * space.weights.position) * squared_norm(u);
    const Real variance = Real(filter.variance_heading), weight = Real(space.weights.heading);
    Real N[Layout::feature_capacity];
    each(zero, layout.features(), [&](auto j) {
        const Vector2<Real> d = space.feature[j] - there;
        const Real squared = squared_norm(d);
        work.seen[j] = in_range(sensor, squared);
        N[j] = believed_variance(filter, sigma_at(sensor, squared));
        if constexpr (Layout::has_heading) {
            work.g[j] = {d.y, -d.x};
            work.v[j] = space.w[j] + scaled(variance, work.g[j]);
            work.c[j] = scaled(half_squared, space.w[j]);
            work.c[j] = add_scaled(add_scaled(work.c[j], a.x, space.x[j]), a.y, space.y[j]);
        }
    });
    each(zero, layout.features(), [&](auto j) {
        Vector2<Real> noise, weighted;
        if constexpr (Layout::has_heading) noise = scaled(variance, work.g[j]), weighted = scaled(weight, work.v[j]);
        each(j, layout.features(), [&](auto l) {
            work.S[j][l] = space.A[j][l];
            work.C[j][l] = space.G[j][l];
            if constexpr (Layout::has_heading) {
                work.S[j][l] = add_outer(work.S[j][l], noise, work.g[l]);
                work.C[j][l] = add_outer(work.C[j][l], weighted, work.v[l]);
                work.C[j][l] = add_outer(work.C[j][l], space.w[j], work.c[l]);
                work.C[j][l] = add_outer(work.C[j][l], work.c[j], space.w[l]);
            }
        });
        work.S[j][j] = add_noise(work.S[j][j], N[j]);
    });
}

/// Eliminates sighting j from S and C, its two rows decorrelated; returns its contribution to trace(S^-1 C).
template <class Layout, class Real, class Index>
CREDENCE_INLINE Real take_out(const Layout& layout, Index j, MeasurementElimination<Layout, Real>& work) {
    auto &S = work.S, &C = work.C;
    const auto pivot = pivot_of(S[j][j], work.seen[j]);
    const auto C_jj = decorrelated_both(pivot, C[j][j]), half = halved(C_jj);
    const Real part = trace_of_quotient(pivot, C_jj);
    Block2<Layout, Real> L[Layout::feature_capacity];
    each(j + one, layout.features(), [&](auto l) {
        S[j][l] = decorrelated(pivot, S[j][l]);
        L[l] = divided(S[j][l], pivot);
        // C_jl less half of C_jj L_l': each of the two products below then takes its half of L_l C_jj L_m'.
        C[j][l] = less_product(decorrelated(pivot, C[j][l]), half, transposed(L[l]));
    });
    each(j + one, layout.features(), [&](auto l) {
        each(l, layout.features(), [&](auto m) {
            S[l][m] = less_product(S[l][m], L[l], S[j][m]);
            C[l][m] = less_product(C[l][m], L[l], C[j][m]);
            C[l][m] = less_product(C[l][m], transposed(C[j][l]), transposed(L[m]));
        });
    });
    return part;
}

/// trace(W P+) of a candidate that moves the robot by u.
template <class Layout, class Real>
CREDENCE_FLAT Real cost_in_measurement_space(const MeasurementSpace<Layout, Real>& space, const Vector2<Real>& u,
                                             const FilterParameters& filter, const SensorParameters& sensor,
                                             const Layout& layout, MeasurementElimination<Layout, Real>& work) {
    return near_at_hand(layout, work, [&](auto& near) CREDENCE_INLINE_LAMBDA {
        form_candidate(space, u, filter, sensor, layout, near);
        Real cost = space.prior.constant;
        if constexpr (Layout::has_heading) cost = space.prior.at({-u.y, u.x}, squared_norm(u));
        each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
            if (any(near.seen[j])) cost = cost - take_out(layout, j, near);
        });
        return cost;
    });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
