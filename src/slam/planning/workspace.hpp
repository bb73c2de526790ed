#pragma once
// What the fast forms of the greedy planner are given, and where they compute.

#include "slam/planning/determinant.hpp"
#include "slam/planning/visible_sets.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

template <class Layout, class Real>
struct PlannerWorkspace {
    Belief<Real, Layout::capacity> still;  ///< before the robot moves, with all of the step's noise but the heading's
    Belief<Real, Layout::capacity> next;   ///< after a candidate, where the direct form decides
    ScreeningWorkspace<Layout, Real> screening;
    MeasurementSpace<Layout, Real> space;
    MeasurementElimination<Layout, Real> elimination;
    VisibleSets<Real> sets;
    DeterminantSpace<Layout, Real> determinants;
    DeterminantTangent<Layout, Real> tangent;
};

/// What is the same at every step, and the workspace.
template <class Layout, class Real>
struct Planning {
    const ControlParameters& control;
    const FilterParameters& filter;
    const SensorParameters& sensor;
    const Layout& layout;
    PlannerWorkspace<Layout, Real>& work;

    /// R(theta^) of work.still.
    Rotation<Real> heading() const {
        if constexpr (Layout::has_heading) return rotation(work.still.mean[Layout::heading]);
        return {};
    }
};

/// Computes the part of the step that is the same for all candidates: that of prepare_candidates, and the robot's fresh
/// position noise, which F does not affect.
template <class Layout, class Real, int capacity>
void prepare_still(const Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout, int k,
                   Belief<Real, capacity>& still) {
    prepare_candidates(belief, filter, layout, k, still);
    add_odometry_noise<Layout>(still.covariance, filter);
}

/// T (1 + s v): the error of a fast form's costs is at most about 50 * 2^-53 times this [docs/theory/model.md,
/// Rounding]. T is at least the trace before the sightings, s at least the sum of the terms of S without the noise, v
/// at least the inverse of any eigenvalue of S. `trace`: of W P with all noise but the sightings', before the robot
/// moves; `odometry`: the position noise that work.still lacks.
template <class Layout, class Real>
CREDENCE_FLAT Real lost_to_rounding(const Planning<Layout, Real>& given, Real trace, double odometry) {
    const auto& [control, filter, sensor, layout, work] = given;
    constexpr auto x = Layout::position;
    const auto& P = work.still.covariance.entry;
    const Vector2<Real> robot = point_at(work.still.mean, x);
    const Real position = P[x][x] + P[x + one][x + one] + Real(2 * odometry), reach = Real(control.squared_reach);
    Real T = trace, s = Real(0);
    if constexpr (Layout::has_heading)
        T = fma(Real(control.weights.position) * reach, P[Layout::heading][Layout::heading], T);
    each(zero, layout.features(), [&](auto j) {
        const auto f = Layout::feature(j);
        s = s + position + P[f][f] + P[f + one][f + one];
        if constexpr (Layout::has_heading) {
            const Real heading = P[Layout::heading][Layout::heading] + Real(given.filter.variance_heading);
            s = fma(heading, reach + squared_range(robot, point_at(given.work.still.mean, f)), s);
        }
    });
    return fma(s * Real(largest_sighting_value(value_parameters(sensor, filter), sensor)), T, T);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
