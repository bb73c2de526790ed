#pragma once
// One trial of one arm, pose by pose. To understand the simulation, read this file first.
//
// The code is a template on `Real`: with double it runs a single trial, with a pack of doubles as many trials at once.

#include "slam/planning/baselines.hpp"
#include "slam/trial/workspace.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

// An observer watches a trial without changing it: the engine's (src/engine/detail.hpp), replay's, which writes the
// trajectory, and those of the tests. It has the functions started, planned, predicted and updated, as called below.

/// The workspace of one trial.
template <class Layout, class Real, class Estimating = KalmanFilter<Layout, Real>>
struct Workspace : CommonWorkspace<Layout, Real, Estimating> {
    PlannerWorkspace<Layout, Real> planner;
    HorizonWorkspace<Layout, Real> horizon;
};

/// One trial of one arm. Every value of `columns` [column_count] and `series` [series_count, K - 1] is written.
template <class Layout, class Real, class Estimating, class Noise, class Observer>
void run_trial(const ProblemView& problem, Controller controller, const Noise& noise, Observer& observer,
               Workspace<Layout, Real, Estimating>& work, Real* columns, Real* all_series) {
    const Layout layout(problem.features);
    const auto features = layout.features();
    auto& truth = work.truth;
    auto& belief = work.belief;
    auto& sightings = work.sightings;
    auto& estimator = work.estimator;
    Sums<Real> sums;
    Outcome<Real> outcome;

    // Pose 0: every feature is initialised, whatever its range.
    WorldDraws<Layout, Real> draws(layout);
    Vector2<Real>* measurement = draws.template of_features<Source::measurement>();
    const auto draw = [&](int k) {
        draws.draw(noise, k);
        shape_tails(problem.sensor, features, k, noise, measurement);
    };
    draw(0);
    start_truth(truth, problem.world, layout, draws, noise);
    look_first(truth, problem.sensor, features, measurement, sightings);
    start_belief(belief, problem.filter, layout, sightings);
    Real error[Layout::capacity];
    estimation_error(belief, truth, layout, error);
    sums.pose_error = squared_pose_error<Layout>(error);
    sums.position = truth.position;
    note_trouble(belief, layout.size(), sums.pose_error, all_lanes<Real>(), 0, outcome);
    estimator.start(layout, belief, truth);
    observer.started(layout, truth, belief);

    for (int k = 1; k < problem.poses; ++k) {
        // Choose the control, from the belief.
        Command<Real> command;
        if (!plans(controller)) {
            command = steered(controller, belief, problem.control, problem.filter, layout, k, noise);
        } else {
            const Planning<Layout, Real> given{problem.control, problem.filter, problem.sensor, layout, work.planner};
            command = plan_ahead(belief, given, k, problem.steps_ahead(controller, k), work.horizon);
            observer.planned(k, layout, belief);
        }

        // Move the robot and the features.
        draw(k);
        move_features(truth, problem.world, layout, k, draws);
        move_robot(truth, problem.world, command, draws);

        // Predict.
        estimator.predict(belief, problem.filter, layout, command, truth, k);

        // See.
        look(truth, problem.sensor, layout, k, measurement, noise, sightings);
        const auto edge_measurement = [&](int e) {
            return measure_edge(truth, problem.sensor, problem.filter.edges[e], k, e, noise);
        };
        const auto linearised = estimator.linearised(belief, layout, truth);
        gate_sightings(belief, problem.filter, layout, linearised, sightings);
        observer.predicted(k, layout, truth, command, belief, sightings, edge_measurement, linearised);

        // Update, and compare with the truth.
        estimator.update(belief, problem.filter, layout, sightings, edge_measurement, linearised, work.update);
        evaluate_step(problem, layout, belief, truth, work.update, k, work.elimination, sums, outcome, all_series);
        observer.updated(k, layout, belief, all_series);
    }
    write_columns(problem, sums, outcome, columns);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
