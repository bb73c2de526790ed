#pragma once
// The workspace of a trial that all built-in worlds have in common.

#include "slam/estimators/estimator.hpp"
#include "slam/trial/step_evaluation.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The workspace of one trial. With 64 features in lanes it is too large for a thread's stack.
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
