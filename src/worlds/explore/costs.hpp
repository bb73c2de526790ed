#pragma once
// What a planner of the world `explore` computes in, and the costs of its candidates. Letters as in
// slam/planning/measurement_space.hpp.

#include "slam/planning/planner.hpp"
#include "worlds/explore/view.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The state with features that enter it: landmarks one by one are no groups where they can be absent.
struct ExploreLayout : Layout<Process::heading, any_count> {
    constexpr ExploreLayout(int features, int groups) : Layout(features), groups_(groups) {}
    constexpr int group_count() const { return groups_; }

private:
    int groups_;
};

/// What the determinants of all candidates have in common [docs/theory/model.md, Determinants].
template <class Real>
struct PoseGivenFeatures {
    Real of_features = Real(0);  ///< log det P_ff of what is in the state
    Symmetric<Real, 3> pose;     ///< C, the pose's covariance given the features
};

/// Where a controller computes, and what a trial knows of the world beside the belief.
template <class Real>
struct ExploreState {
    using State = ExploreLayout;
    PlannerWorkspace<State, Real> planner;
    Belief<Real, State::capacity> of_one;         ///< of the trial that is planned for, in all lanes
    MeasurementSpace<State, Real> space_of_one;
    PoseGivenFeatures<Real> given, given_of_one;
    Mask<Real> mapped[State::feature_capacity];  ///< whether a sighting, or the start, has given the landmark its place
    /// [planner.horizon, cells] Only the first row is kept from step to step.
    Mask<Real>* viewed = nullptr;
    Belief<Real, State::capacity>* ahead = nullptr;  ///< [planner.horizon] where this is more than 1
    int *queue = nullptr, *from = nullptr;       ///< [cells] of a search through the grid

    /// Where landmark j is in the state.
    Mask<Real> present(const ExploreView& problem, int j) const {
        return problem.map == LandmarkMap::none ? mapped[j] : all_lanes<Real>();
    }
};

/// The sightings of a candidate that moves the robot by u, those of which `sees(j, squared)` is true in some lane: S of
/// them in `work`, which of the features they are, and their variances. Returns their number.
template <class Real, class Sees>
CREDENCE_INLINE int gather_sightings(const MeasurementSpace<ExploreLayout, Real>& space, const Vector2<Real>& u,
                                     const ExploreView& problem, const ExploreLayout& layout, const Sees& sees,
                                     MeasurementElimination<ExploreLayout, Real>& work, int* of, Real* N) {
    const Vector2<Real> there = space.position + u;
    const Real variance = Real(problem.filter.variance_heading);
    int count = 0;
    for (int j = 0; j < layout.features(); ++j) {
        const Vector2<Real> d = space.feature[j] - there;
        const Real squared = squared_norm(d);
        work.seen[count] = sees(j, squared);
        if (!any(work.seen[count])) continue;
        N[count] = believed_variance(problem.filter, sigma_at(problem.sensor, squared));
        work.g[count] = {d.y, -d.x};
        of[count++] = j;
    }
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> noise = scaled(variance, work.g[i]);
        for (int l = i; l < count; ++l) work.S[i][l] = add_outer(space.A[of[i]][of[l]], noise, work.g[l]);
        work.S[i][i] = add_noise(work.S[i][i], N[i]);
    }
    return count;
}

/// trace(W P+) of a candidate.
template <class Real, class Sees>
CREDENCE_FLAT Real trace_in_measurement_space(const MeasurementSpace<ExploreLayout, Real>& space,
                                              const Vector2<Real>& u, const ExploreView& problem,
                                              const ExploreLayout& layout, const Sees& sees,
                                              MeasurementElimination<ExploreLayout, Real>& work) {
    const Vector2<Real> a{-u.y, u.x};
    const Real half_squared = Real(0.5 * space.weights.position) * squared_norm(u);
    const Real variance = Real(problem.filter.variance_heading), weight = Real(space.weights.heading);
    int of[ExploreLayout::feature_capacity];
    Real N[ExploreLayout::feature_capacity];
    const int count = gather_sightings(space, u, problem, layout, sees, work, of, N);
    for (int i = 0; i < count; ++i) {
        const int j = of[i];
        work.v[i] = space.w[j] + scaled(variance, work.g[i]);
        work.c[i] = add_scaled(add_scaled(scaled(half_squared, space.w[j]), a.x, space.x[j]), a.y, space.y[j]);
    }
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> weighted = scaled(weight, work.v[i]);
        for (int l = i; l < count; ++l) {
            work.C[i][l] = add_outer(space.G[of[i]][of[l]], weighted, work.v[l]);
            work.C[i][l] = add_outer(work.C[i][l], space.w[of[i]], work.c[l]);
            work.C[i][l] = add_outer(work.C[i][l], work.c[i], space.w[of[l]]);
        }
    }
    Real cost = space.prior.at(a, squared_norm(u));
    const ExploreLayout those(count, 0);
    for (int i = 0; i < count; ++i) cost = cost - take_out(those, i, work);
    return cost;
}

/// Calls visit(i, pivot) with the pivots of C + sigma^2 t t', t = (1, u_y, -u_x).
template <class Real, class Visit>
CREDENCE_INLINE void each_pose_pivot(const PoseGivenFeatures<Real>& given, Real variance, const Vector2<Real>& u,
                                     const Visit& visit) {
    const Real t[] = {Real(1), u.y, -u.x};
    Symmetric<Real, 3> room;
    int place = 0;
    each_pivot(3, [&](int i, int j) { return fma(variance * t[j], t[i], given.pose.entry[j][i]); }, room,
               [&](const Real& pivot) { visit(place++, pivot); });
}

/// log det P+ of a candidate, of what is in the state: log(det P_ff det(C + sigma^2 t t') det N / det S)
template <class Real, class Sees>
CREDENCE_FLAT Real log_det_in_measurement_space(const PoseGivenFeatures<Real>& given,
                                                const MeasurementSpace<ExploreLayout, Real>& space,
                                                const Vector2<Real>& u, const ExploreView& problem,
                                                const ExploreLayout& layout, const Sees& sees,
                                                MeasurementElimination<ExploreLayout, Real>& work) {
    int of[ExploreLayout::feature_capacity];
    Real N[ExploreLayout::feature_capacity];
    const int count = gather_sightings(space, u, problem, layout, sees, work, of, N);
    ScaledProduct<Real> product;
    each_pose_pivot(given, Real(problem.filter.variance_heading), u,
                    [&](int, const Real& pivot) { product.multiply(pivot); });
    for (int i = 0; i < count; ++i) {
        const auto pivot = pivot_of(work.S[i][i], work.seen[i]);
        const Real precisions = pivot.precision.x * pivot.precision.y;
        product.multiply(select(work.seen[i], N[i] * N[i] * precisions, Real(1)));
        Matrix2<Real> L[ExploreLayout::feature_capacity];
        for (int l = i + 1; l < count; ++l) {
            work.S[i][l] = decorrelated(pivot, work.S[i][l]);
            L[l] = divided(work.S[i][l], pivot);
        }
        for (int l = i + 1; l < count; ++l)
            for (int m = l; m < count; ++m) work.S[l][m] = less_product(work.S[l][m], L[l], work.S[i][m]);
    }
    return given.of_features + product.log();
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
