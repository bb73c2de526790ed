#pragma once
// One trial of one arm in the world of landmarks, poses in order [docs/estimators.md]. It reads like
// slam/trial/trial.hpp, and shares everything with it but the world: layout, belief, estimators, update, evaluation and
// observers.

#include "worlds/landmarks/problem.hpp"
#include "slam/trial/workspace.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Landmarks that pose k shows for the first time enter the belief.
template <class Layout, class Real, class Estimating>
void initialise_landmarks(const LandmarkView& problem, const Layout& layout, int k,
                          CommonWorkspace<Layout, Real, Estimating>& work) {
    for (int j = 0; j < layout.features(); ++j) {
        if (problem.world.first_pose[j] != k) continue;
        work.sightings[j].seen = all_lanes<Real>();
        work.estimator.initialise(work.belief, problem.filter, layout, j, work.sightings[j], work.truth);
    }
}

/// Pose 0, which is known: landmarks in sight are initialised, of the others there is a prior.
template <class Layout, class Real, class Estimating, class Noise>
void start_trial(const LandmarkView& problem, const Layout& layout, const Noise& noise,
                 LandmarkDraws<Layout, Real>& draws, CommonWorkspace<Layout, Real, Estimating>& work) {
    const int features = layout.features();
    start_truth(work.truth, problem.world, features);
    for (int j = 0; j < features; ++j) work.sightings[j] = drawn_prior(work.truth, problem.world, j, noise);
    start_belief(work.belief, problem.filter, layout, work.sightings);
    work.estimator.start(layout, work.belief, work.truth);
    draws.draw(noise, 0);
    look(work.truth, problem.sensor, layout, 0, draws.template of_features<Source::measurement>(), noise,
         work.sightings);
    initialise_landmarks(problem, layout, 0, work);
}

/// One trial of one arm. `columns` [column_count]; `series` [series_count, K - 1]; both are written whole.
template <class Layout, class Real, class Estimating, class Noise, class Observer>
void run_trial(const LandmarkView& problem, const Noise& noise, Observer& observer,
               CommonWorkspace<Layout, Real, Estimating>& work, Real* columns, Real* all_series) {
    const Layout layout(problem.features);
    auto& truth = work.truth;
    auto& belief = work.belief;
    auto& sightings = work.sightings;
    auto& estimator = work.estimator;
    const auto no_edge = [](int) { return Vector2<Real>{}; };
    Sums<Real> sums;
    Outcome<Real> outcome;
    LandmarkDraws<Layout, Real> draws(layout);
    start_trial(problem, layout, noise, draws, work);
    sums.position = truth.position;
    observer.started(layout, truth, belief);

    for (int k = 1; k < problem.poses; ++k) {
        // The robot moves on along its loop, and its filter knows that.
        stand_at(truth, problem.world, k);
        draws.draw(noise, k);
        const Command<Real> reported = reported_motion(problem.world, k, draws);

        // Predict.
        estimator.predict(belief, problem.filter, layout, reported, truth, k);

        // See.
        look(truth, problem.sensor, layout, k, draws.template of_features<Source::measurement>(), noise, sightings);
        const int first_sights = set_aside_first_sights(problem.world, layout.features(), k, sightings);
        const auto linearised = estimator.linearised(belief, layout, truth);
        observer.predicted(k, layout, truth, reported, belief, sightings, no_edge, linearised);

        // Update with the landmarks that are known, initialise those that are new, and compare with the truth.
        estimator.update(belief, problem.filter, layout, sightings, no_edge, linearised, work.update);
        initialise_landmarks(problem, layout, k, work);
        work.update.unseen = work.update.unseen - Real(first_sights);
        evaluate_step(problem, layout, belief, truth, work.update, k, work.elimination, sums, outcome, all_series);
        all_series[(problem.series_count - 1) * (problem.poses - 1) + k - 1] = work.update.unsettled;
        observer.updated(k, layout, belief, all_series);
    }
    write_columns(problem, sums, outcome, columns);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
