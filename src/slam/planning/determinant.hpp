#pragma once
// Screening by a determinant: lower bounds on log det P+ of the state or of the pose, tangent at a reference
// [docs/theory/model.md, Determinants]. With the symbols of determinant_space.hpp:
// R' (S + 1/v)^-1 R is concave in v for S = K - kappa I, F - kappa I, and so is log det(I + S v): their tangents at a
// reference bound them from above.

#include "slam/planning/determinant_space.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// A tangent at a reference.
template <class Layout, class Real>
struct DeterminantTangent {
    PoseForm<Layout, Real> heading, pose;  ///< sigma^2 H_p' (K + N)^-1 H_p; X' (F + N)^-1 X
    Real constant{};                       ///< -log det(I + (K - kappa I) v) at v = 0, on all axes
    Real slope[Layout::feature_capacity];  ///< its fall with v_j
};

/// A reference: v_j, the believed variances, and what is seen.
template <class Layout, class Real>
struct Reference {
    Real value[Layout::feature_capacity], variance[Layout::feature_capacity];
    Mask<Real> seen[Layout::feature_capacity];
};

/// The tangents of scale R' (S + N)^-1 R at a reference and, with `slope`, of log det(I + (S - kappa I) v), whose value
/// at v = 0 is returned. J holds R and S, and is used up.
template <bool determinant, class Layout, class Real>
CREDENCE_INLINE Real touch(JointMatrix<Layout, Real>& J, const Reference<Layout, Real>& at, const Layout& layout,
                           double kappa, Real scale, PoseForm<Layout, Real>& form, Real* slope) {
    using Pose = BoundedPose<Layout>;
    const auto rows = Pose::rows(layout);
    ScaledProduct<Real> product;
    each(zero, Pose::size, [&](auto r) { each(r, Pose::size, [&](auto c) { J.entry[r][c] = Real(0); }); });
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        each(Pose::row(j), Pose::row(j) + Pose::axes, [&](auto i) CREDENCE_INLINE_LAMBDA {
            J.entry[i][i] = J.entry[i][i] + select(at.seen[j], at.variance[j], Real(0));
        });
    });
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        each(Pose::row(j), Pose::row(j) + Pose::axes, [&](auto i) CREDENCE_INLINE_LAMBDA {
            const Real pivot = sweep(J, rows, i, at.seen[j]);
            if constexpr (determinant) product.multiply(select(at.seen[j], pivot * at.value[j], Real(1)));
        });
    });
    Real constant = Real(0);
    if constexpr (determinant) constant = product.log();
    const auto negated_scale = -scale;
    form.each_entry_of(form.constant, [&](auto r, auto c) CREDENCE_INLINE_LAMBDA {
        form.constant.entry[r][c] = negated_scale * J.entry[r][c];
    });
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        const Real stretch = select(at.seen[j], Real(kappa) + at.variance[j], Real(1));
        const Real square = scale * stretch * stretch;
        Real fall = Real(0);
        form.each_entry_of(form.constant, [&](auto r, auto c) CREDENCE_INLINE_LAMBDA {
            Real sum = Real(0);
            each(Pose::row(j), Pose::row(j) + Pose::axes,
                 [&](auto i) CREDENCE_INLINE_LAMBDA { sum = fma(J.entry[r][i], J.entry[c][i], sum); });
            form.slope[j].entry[r][c] = square * sum;
            form.constant.entry[r][c] = fnma(at.value[j], form.slope[j].entry[r][c], form.constant.entry[r][c]);
        });
        if constexpr (determinant) {
            each(Pose::row(j), Pose::row(j) + Pose::axes, [&](auto i) CREDENCE_INLINE_LAMBDA {
                const Real diagonal = J.entry[i][i];
                fall = fall + select(at.seen[j], stretch * fma(diagonal, stretch, Real(1)), diagonal - Real(kappa));
            });
            slope[j] = fall;
            constant = fnma(at.value[j], fall, constant);
        }
    });
    return constant;
}

/// The tangent at a move of the robot.
template <bool full, class Layout, class Real>
CREDENCE_FLAT void touch_at(const Vector2<Real>& move, const FilterParameters& filter, const SensorParameters& sensor,
                            const Layout& layout, double kappa, const DeterminantSpace<Layout, Real>& space,
                            DeterminantTangent<Layout, Real>& tangent) {
    const Vector2<Real> there = space.position + move;
    Reference<Layout, Real> at;
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_range(there, space.feature[j]);
        at.seen[j] = in_range(sensor, squared);
        at.variance[j] = believed_variance(filter, sigma_at(sensor, squared));
        at.value[j] = select(at.seen[j], Real(1) / (Real(kappa) + at.variance[j]), Real(0));
    });
    constexpr int copies = 2 / BoundedPose<Layout>::axes;
    JointMatrix<Layout, Real> J;
    if constexpr (full || Layout::has_heading) {
        J = space.whole;
        tangent.constant = touch<full>(J, at, layout, kappa, Real(filter.variance_heading), tangent.heading,
                                       tangent.slope);
    }
    if constexpr (full) {
        tangent.constant = fnma(Real(copies), tangent.constant, space.log_features);
        each(zero, layout.features(), [&](auto j) { tangent.slope[j] = Real(copies) * tangent.slope[j]; });
    } else {
        J = space.given_pose;
        touch<false>(J, at, layout, kappa, Real(1), tangent.pose, tangent.slope);
    }
}

/// det(I + X' (F + N)^-1 X) of X' (F + N)^-1 X; clears `reliable` where rounding may exceed the margin.
template <class Layout, class Real>
CREDENCE_INLINE Real determinant_of_pose(Symmetric<Real, 3> seen, Mask<Real>& reliable) {
    auto& e = seen.entry;
    each(zero, Known<3>{}, [&](auto r) CREDENCE_INLINE_LAMBDA { e[r][r] = Real(1) + e[r][r]; });
    const Real product = e[0][0] * e[1][1] * e[2][2];
    const Real a = fnma(e[1][2], e[1][2], e[1][1] * e[2][2]), b = fnma(e[1][2], e[0][2], e[0][1] * e[2][2]),
               c = fnma(e[1][1], e[0][2], e[0][1] * e[1][2]);
    const Real det = fma(e[0][2], c, fnma(e[0][1], b, e[0][0] * a));
    reliable = both(reliable, product <= Real(1e8) * det);
    return det;
}

/// A candidate's cost as its bound compares with it: log det P+ of the state; det P+ of the pose, or its root where one
/// axis is computed.
template <bool full, class Layout, class Real>
Real bounded_cost(Real cost) {
    if constexpr (full) return cost;
    return exp(Real(0.5 * BoundedPose<Layout>::axes) * cost);
}

/// t' A t for a move in the body frame.
template <class Real>
Real form_at(const Symmetric<Real, 3>& A, const Point& move, Real constant) {
    const auto& e = A.entry;
    const double x = move.x, y = move.y;
    Real sum = constant + e[0][0];
    sum = fma(Real(2 * y), e[0][1], fma(Real(-2 * x), e[0][2], sum));
    return fma(Real(y * y), e[1][1], fma(Real(-2 * x * y), e[1][2], fma(Real(x * x), e[2][2], sum)));
}

/// The lower bound on a candidate's bounded cost, whose v_j are value(j). Minus infinity where rounding may exceed it.
template <bool full, class Layout, class Real, class Value>
CREDENCE_INLINE Real determinant_bound(const DeterminantTangent<Layout, Real>& tangent,
                                       const DeterminantSpace<Layout, Real>& space, const Layout& layout, double kappa,
                                       const Point& move, const Value& value) {
    Real above = space.prior_constant, below = Real(1);
    Mask<Real> reliable = all_lanes<Real>();
    if constexpr (Layout::has_heading) {
        above = form_at(space.prior, move, above);
        reliable = space.lost <= Real(1e8) * above;
    }
    Real sum = value(zero);
    each(one, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA { sum = sum + value(j); });
    const Mask<Real> sees = sum > Real(0);
    if (full || any(sees)) {  // where nothing is seen, nothing is divided by
        if constexpr (Layout::has_heading) below = form_at(tangent.heading.at(layout, value), move, below);
        if constexpr (!full) {
            if constexpr (Layout::has_heading)
                below = below * determinant_of_pose<Layout>(tangent.pose.at(layout, value), reliable);
            else
                below = below + tangent.pose.at(layout, value).entry[0][0];
            below = select(sees, below, Real(1));
        }
    }
    if constexpr (full) {
        Real least = tangent.constant, free = Real(1);
        each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
            free = free * fnma(Real(kappa), value(j), Real(1));
            least = fnma(tangent.slope[j], value(j), least);
        });
        const Real ratio = above * (Layout::has_heading ? free * free : free) / below;
        reliable = both(reliable, both(ratio > Real(1e-300), ratio < Real(1e300)));
        return select(reliable, fma(Real(2 / BoundedPose<Layout>::axes), log_of_normal(ratio), least),
                      -without_limit<Real>());
    }
    return select(both(reliable, below > Real(0)), above / below, -without_limit<Real>());
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
