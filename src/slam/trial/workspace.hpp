#pragma once
// What the trials of every world of ours need room for.

#include "slam/estimators/estimator.hpp"
#include "slam/trial/step_evaluation.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// One trial's. Sixty-four features in lanes would not fit a thread's stack.
template <class Layout, class Real, class Estimating = KalmanFilter<Layout, Real>>
struct CommonWorkspace {
    static_assert(meets_the_contract<Estimating, Layout, Real>());
    Truth<Real, Layout::feature_capacity> truth;
    Belief<Real, Layout::capacity> belief;
    Sighting<Real> sightings[Layout::feature_capacity];
    Update<Real, Layout::capacity> update;
    Elimination<Real, Layout::capacity> elimination;
    Estimating estimator;
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
