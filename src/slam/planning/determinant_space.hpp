#pragma once
// What bounds by a determinant have in common for all candidates of a step [docs/theory/model.md, Determinants].
//
//   P, H0, u, v_j, kappa as in screening.hpp; K = H0 P H0', H_p the pose's columns of H0; sigma^2 the variance of the
//   fresh heading noise; t = T^-1 e_theta = (1, u_y, -u_x); P_p|f  covariance of the pose given the features
//   det P+ of the state = det P_ff det(P_p|f + sigma^2 t t') det N / (det(K + N) (1 + sigma^2 t'H_p'(K + N)^-1 H_p t))
//   P_p = C C', X = H0 P_.p C'^-1, F = K - X X': the sightings' covariance given the pose
//   det P+ of the pose >= det(P_p + sigma^2 t t') / (det(I + X' (F + N)^-1 X) (1 + sigma^2 t' H_p' (K + N)^-1 H_p t))
// The candidates' moves are the same in all lanes in the body frame: the pose turns into it. In the translation model
// both axes are alike, and one is computed.

#include "slam/planning/screening.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The pose as the bounds see it: all of it or, without a heading, one axis of it.
template <class Layout>
struct BoundedPose {
    static constexpr Known<Layout::has_heading ? 3 : 1> size{};
    static constexpr Known<Layout::has_heading ? 2 : 1> axes{};  ///< rows of a sighting
    static constexpr int capacity = size + axes * Layout::feature_capacity;

    /// Row of sighting j where the pose's rows come first.
    static constexpr auto row(auto j) { return size + axes * j; }
    static constexpr auto rows(const Layout& layout) { return row(layout.features()); }
};

/// The pose and the sightings: [0 R'; R S].
template <class Layout, class Real>
using JointMatrix = Symmetric<Real, BoundedPose<Layout>::capacity>;

/// A matrix of the pose that is linear in v.
template <class Layout, class Real>
struct PoseForm {
    using Matrix = Symmetric<Real, BoundedPose<Layout>::size>;
    Matrix constant, slope[Layout::feature_capacity];

    template <class Value>
    Matrix at(const Layout& layout, const Value& value) const {
        Matrix sum = constant;
        each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
            each_entry_of(sum, [&](auto r, auto c) CREDENCE_INLINE_LAMBDA {
                sum.entry[r][c] = fma(value(j), slope[j].entry[r][c], sum.entry[r][c]);
            });
        });
        return sum;
    }
    template <class Use>
    static void each_entry_of(const Matrix&, const Use& use) {
        constexpr auto size = BoundedPose<Layout>::size;
        each(zero, size,
             [&](auto r) CREDENCE_INLINE_LAMBDA { each(r, size, [&](auto c) CREDENCE_INLINE_LAMBDA { use(r, c); }); });
    }
};

/// The quantities that are the same for all candidates of a step.
template <class Layout, class Real>
struct DeterminantSpace {
    Vector2<Real> position, feature[Layout::feature_capacity];  ///< means
    JointMatrix<Layout, Real> whole, given_pose;  ///< R = H_p, S = K; R = X, S = F
    Symmetric<Real, BoundedPose<Layout>::size> prior;  ///< sigma^2 adj(P_p|f) or sigma^2 adj(P_p); nothing on one axis
    Real prior_constant;                               ///< det P_p|f or det P_p
    Real log_features;                                 ///< log det P_ff
    Real lost;                                         ///< greatest product of the pose's variances: rounding scales
    Symmetric<Real, Layout::capacity> room;
};

/// A pose's symmetric matrix turned into the body frame: D' A D, D = diag(1, R).
template <class Real>
void turn_into_body(Symmetric<Real, 3>& A, const Rotation<Real>& heading) {
    auto& e = A.entry;
    const Vector2<Real> t = rotate_back(heading, Vector2<Real>{e[0][1], e[0][2]});
    const Vector2<Real> x = rotate_back(heading, Vector2<Real>{e[1][1], e[1][2]}),  // A_rr R, transposed
        y = rotate_back(heading, Vector2<Real>{e[1][2], e[2][2]});
    const Vector2<Real> first = rotate_back(heading, Vector2<Real>{x.x, y.x}),
                        second = rotate_back(heading, Vector2<Real>{x.y, y.y});
    e[0][1] = t.x, e[0][2] = t.y, e[1][1] = first.x, e[1][2] = first.y, e[2][2] = second.y;
}

template <class Real>
Symmetric<Real, 3> adjugate(const Symmetric<Real, 3>& A) {
    const auto& e = A.entry;
    Symmetric<Real, 3> result;
    const auto minor = [](Real a, Real b, Real c, Real d) { return fnma(b, c, a * d); };
    result.entry[0][0] = minor(e[1][1], e[1][2], e[1][2], e[2][2]);
    result.entry[0][1] = minor(e[0][2], e[0][1], e[2][2], e[1][2]);
    result.entry[0][2] = minor(e[0][1], e[0][2], e[1][1], e[1][2]);
    result.entry[1][1] = minor(e[0][0], e[0][2], e[0][2], e[2][2]);
    result.entry[1][2] = minor(e[0][2], e[0][0], e[1][2], e[0][1]);
    result.entry[2][2] = minor(e[0][0], e[0][1], e[0][1], e[1][1]);
    return result;
}

/// det A, given its adjugate's first row.
template <class Real>
Real determinant(const Symmetric<Real, 3>& A, const Symmetric<Real, 3>& adjugate_of_A) {
    const auto &e = A.entry, &a = adjugate_of_A.entry;
    return fma(e[0][0], a[0][0], fma(e[0][1], a[0][1], e[0][2] * a[0][2]));
}

/// The pose's columns of H0, its position turned into the body frame.
template <class Layout, class Real>
CREDENCE_INLINE void fill_pose_columns(const DeterminantSpace<Layout, Real>& space, const Rotation<Real>& heading,
                                       const Layout& layout, JointMatrix<Layout, Real>& J) {
    auto& R = J.entry;
    each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
        const auto row = BoundedPose<Layout>::row(j);
        if constexpr (Layout::has_heading) {
            const Vector2<Real> d = space.feature[j] - space.position;
            R[0][row] = d.y, R[0][row + one] = -d.x;
            R[1][row] = -heading.cosine, R[1][row + one] = -heading.sine;
            R[2][row] = heading.sine, R[2][row + one] = -heading.cosine;
        } else {
            R[0][row] = Real(-1);
        }
    });
}

/// From P to K and to the pose's rows of P H0': J = [P_p, P_p. H0'; H0 P_.p, K].
template <class Layout, class Real, int capacity>
CREDENCE_INLINE void fill_covariances(const Symmetric<Real, capacity>& P, const Real* mean, const Layout& layout,
                                      JointMatrix<Layout, Real>& J) {
    using Pose = BoundedPose<Layout>;
    each(zero, Pose::size, [&](auto r) { each(r, Pose::size, [&](auto c) { J.entry[r][c] = P.entry[r][c]; }); });
    each(zero, layout.features(), [&](auto l) CREDENCE_INLINE_LAMBDA {
        const auto rows = sighting_rows<Layout>(mean, l);
        const auto column = Pose::row(l);
        Vector2<Real> B[capacity];
        each(zero, layout.feature(l + one), [&](auto i) CREDENCE_INLINE_LAMBDA {
            if (Layout::has_heading || i % 2 == 0) B[i] = rows([&](auto s) { return P.at(i, s); });
        });
        each(zero, Pose::size, [&](auto c) CREDENCE_INLINE_LAMBDA {
            J.entry[c][column] = B[c].x;
            if constexpr (Layout::has_heading) J.entry[c][column + one] = B[c].y;
        });
        each(zero, l + one, [&](auto j) CREDENCE_INLINE_LAMBDA {
            const auto others = sighting_rows<Layout>(mean, j);
            const auto row = Pose::row(j);
            const Vector2<Real> x = others([&](auto s) { return B[s].x; });
            J.entry[row][column] = x.x;
            if constexpr (Layout::has_heading) {
                const Vector2<Real> y = others([&](auto s) { return B[s].y; });
                J.entry[row][column + one] = y.x;
                if (j != l) J.entry[row + one][column] = x.y;
                J.entry[row + one][column + one] = y.y;
            }
        });
    });
}

/// Computes the shared quantities from the belief before the robot moves, which lacks the robot's fresh noise. `full`:
/// for the state's determinant, not the pose's. Returns a bound on the sum of the terms that K is made of.
template <bool full, class Layout, class Real, int capacity>
CREDENCE_FLAT Real enter_determinant_space(const Belief<Real, capacity>& still, const Rotation<Real>& heading,
                                           const FilterParameters& filter, double squared_reach, const Layout& layout,
                                           DeterminantSpace<Layout, Real>& space) {
    using Pose = BoundedPose<Layout>;
    constexpr auto x = Layout::position;
    const auto n = layout.size();
    const auto rows = Pose::rows(layout);
    auto& P = space.room;
    copy(still.covariance, n, P);
    add_odometry_noise<Layout>(P, filter);
    space.position = point_at(still.mean, x);
    Real terms = Real(0);
    each(zero, layout.features(), [&](auto j) {
        const auto f = Layout::feature(j);
        space.feature[j] = point_at(still.mean, f);
        terms = terms + P.entry[x][x] + P.entry[x + one][x + one] + P.entry[f][f] + P.entry[f + one][f + one];
        if constexpr (Layout::has_heading)
            terms = fma(P.entry[0][0], squared_range(space.position, space.feature[j]), terms);
    });
    fill_covariances(P, still.mean, layout, space.whole);
    if constexpr (!full) {
        auto& J = space.given_pose;
        J = space.whole;
        Real X[Pose::size][Pose::capacity];
        each(zero, Pose::size, [&](auto c) {
            const Real variance = J.entry[c][c];
            const Real scale = select(variance > Real(0), Real(1) / sqrt(variance), Real(0));
            each(Pose::size, rows, [&](auto i) { X[c][i] = scale * J.entry[c][i]; });
            sweep(J, rows, c, all_lanes<Real>());
        });
        each(zero, Pose::size, [&](auto c) { each(Pose::size, rows, [&](auto i) { J.entry[c][i] = X[c][i]; }); });
    }
    fill_pose_columns(space, heading, layout, space.whole);
    if constexpr (Layout::has_heading) {
        const Real reach = Real(filter.variance_heading * squared_reach);
        space.lost =
            (P.entry[0][0] + Real(filter.variance_heading)) * (P.entry[x][x] + reach) * (P.entry[2][2] + reach);
    }
    if constexpr (full) {
        ScaledProduct<Real> product;
        each(Layout::pose_size, n, [&](auto i) { product.multiply(sweep(P, n, i, all_lanes<Real>())); });
        space.log_features = product.log();
    }
    if constexpr (Layout::has_heading) {
        Symmetric<Real, 3> pose;
        PoseForm<Layout, Real>::each_entry_of(pose, [&](auto r, auto c) { pose.entry[r][c] = P.entry[r][c]; });
        turn_into_body(pose, heading);
        space.prior = adjugate(pose);
        space.prior_constant = determinant(pose, space.prior);
        PoseForm<Layout, Real>::each_entry_of(pose, [&](auto r, auto c) {
            space.prior.entry[r][c] = Real(filter.variance_heading) * space.prior.entry[r][c];
        });
    } else {
        space.prior_constant = P.entry[0][0];
    }
    return Real(1) + terms;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
