#pragma once
// Room 8: one trial of one arm, poses in order. The page to open first.
//
// Templates on `Real`: with double a trial is what it reads like; with a pack of doubles it is that many trials at
// once.

#include <credence/problem.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Watches a trial without touching it; the engine's watches nothing, replay's writes the trajectory.
struct NoObserver {
    template <class... Anything>
    void started(const Anything&...) {}
    template <class... Anything>
    void cost(const Anything&...) {}
    template <class... Anything>
    void predicted(const Anything&...) {}
    template <class... Anything>
    void updated(const Anything&...) {}
};

/// A trial's status and the pose where it happened. Failures are final; a diverged trial may still fail.
template <class Real>
struct Outcome {
    Real status = Real(0), pose = Real(-1);

    void note(Mask<Real> happened, Status what, int k) {
        const Real code = Real(static_cast<int>(what));
        const Mask<Real> worse = both(happened, both(status < Real(2), status < code));
        status = select(worse, code, status);
        pose = select(worse, Real(k), pose);
    }
};

/// Sums over the poses of one trial.
template <class Real>
struct Sums {
    Real unseen = Real(0), pose_error = Real(0), nees = Real(0), nis = Real(0), rows = Real(0), trace = Real(0);
};

/// x^ - x, heading wrapped. Shape [n].
template <class Layout, class Real, int state_capacity, int feature_capacity>
void estimation_error(const Belief<Real, state_capacity>& belief, const Truth<Real, feature_capacity>& truth,
                      const Layout& layout, Real* error) {
    if constexpr (Layout::has_heading)
        error[Layout::heading] = wrapped(belief.mean[Layout::heading] - truth.heading);
    error[Layout::position] = belief.mean[Layout::position] - truth.position.x;
    error[Layout::position + 1] = belief.mean[Layout::position + 1] - truth.position.y;
    for (int j = 0; j < layout.features(); ++j) {
        error[Layout::feature(j)] = belief.mean[Layout::feature(j)] - truth.feature[j].x;
        error[Layout::feature(j) + 1] = belief.mean[Layout::feature(j) + 1] - truth.feature[j].y;
    }
}

/// |x^_pose - x_pose|^2, heading included where there is one.
template <class Layout, class Real>
Real squared_pose_error(const Real* error) {
    Real sum = error[0] * error[0];
    for (int i = 1; i < Layout::pose_size; ++i) sum = fma(error[i], error[i], sum);
    return sum;
}

/// Sorts out what went wrong at pose k, if anything did. `squared_errors` says nothing where a matrix was not positive
/// definite.
template <class Real, int capacity>
void note_trouble(const Belief<Real, capacity>& belief, int n, Real squared_errors, Mask<Real> positive_definite,
                  int k, Outcome<Real>& outcome) {
    Real largest = Real(0), zero_if_finite = select(positive_definite, squared_errors, Real(0)) * Real(0);
    for (int i = 0; i < n; ++i) {
        const Real x = absolute(belief.mean[i]);
        largest = select(x > largest, x, largest);
        zero_if_finite = fma(x, Real(0), zero_if_finite);
        for (int j = i; j < n; ++j) {
            const Real p = absolute(belief.covariance.entry[i][j]);
            largest = select(p > largest, p, largest);
            zero_if_finite = fma(p, Real(0), zero_if_finite);
        }
    }
    outcome.note(negated(zero_if_finite == Real(0)), Status::non_finite, k);
    outcome.note(negated(positive_definite), Status::covariance_not_positive_definite, k);
    outcome.note(largest > Real(divergence_bound), Status::diverged, k);
}

/// Judges the belief at pose k against the truth: writes the step's figures (in the order of step_figures) and sums.
template <class Layout, class Real, int state_capacity, int feature_capacity>
void judge_step(const ProblemView& problem, const Layout& layout, const Belief<Real, state_capacity>& belief,
                const Truth<Real, feature_capacity>& truth, const UpdateResult<Real>& update, int k,
                Sums<Real>& sums, Outcome<Real>& outcome, Real* figures) {
    const int steps = problem.poses - 1, n = layout.size();
    Real* next = figures + (k - 1);
    const auto write = [&](Real value) { *next = value, next += steps; };

    Real error[state_capacity];
    estimation_error(belief, truth, layout, error);
    const Real reported = Real(problem.filter.covariance_factor);
    Mask<Real> positive_definite = update.positive_definite;
    Real whole = Real(0);
    for (int b = 0; b < problem.block_count; ++b) {
        const BlockRange block = problem.blocks[b];
        const SquaredError<Real> nees =
            normalised_squared_error(belief.covariance, error, block.first, block.count);
        positive_definite = both(positive_definite, nees.positive_definite);
        const Real value = nees.value / reported;
        if (b == 0) whole = value;
        write(value);
    }
    const Real trace_P = reported * trace(belief.covariance, n);
    const Real squared_error = squared_pose_error<Layout>(error);
    write(update.nis);
    write(update.rows);
    write(update.unseen);
    write(trace_P);
    write(squared_error);
    for (int i = 0; i < n; ++i) write(error[i] / sqrt(reported * belief.covariance.entry[i][i]));

    sums.nees = sums.nees + whole / Real(n);
    sums.nis = sums.nis + update.nis;
    sums.rows = sums.rows + update.rows;
    sums.unseen = sums.unseen + update.unseen;
    sums.pose_error = sums.pose_error + squared_error;
    sums.trace = trace_P;
    note_trouble(belief, n, whole + update.nis, positive_definite, k, outcome);
}

/// The trial's columns in the order of ColumnIndex; those of a failed trial are filled by the engine.
template <class Real>
void write_columns(const Sums<Real>& sums, const Outcome<Real>& outcome, int steps, Real* columns) {
    columns[column_trace_P] = sums.trace;
    columns[column_unseen] = sums.unseen;
    columns[column_pose_error] = sums.pose_error;
    columns[column_nees_ratio] = sums.nees / Real(steps);
    columns[column_nis_ratio] = sums.nis / sums.rows;
    columns[column_status] = outcome.status;
    columns[column_status_pose] = outcome.pose;
}

/// One trial of one arm. `columns` [column_count]; `figures` [figure_count, K - 1]; both are written whole.
template <class Layout, class Real, class Noise, class Observer>
void run_trial(const ProblemView& problem, Controller controller, const Noise& noise, Observer& observer,
               Real* columns, Real* figures) {
    const Layout layout(problem.features);
    const int features = layout.features();
    Truth<Real, Layout::feature_capacity> truth;
    Belief<Real, Layout::capacity> belief{};
    Sighting<Real> sightings[Layout::feature_capacity];
    Sums<Real> sums;
    Outcome<Real> outcome;

    // Pose 0: every feature is initialised, whatever its range.
    start_truth(truth, problem.world, features, noise);
    for (int j = 0; j < features; ++j) sightings[j] = first_sight(truth, problem.sensor, j, noise);
    start_belief(belief, problem.filter, layout, sightings);
    Real error[Layout::capacity];
    estimation_error(belief, truth, layout, error);
    sums.pose_error = squared_pose_error<Layout>(error);
    note_trouble(belief, layout.size(), sums.pose_error, all_lanes<Real>(), 0, outcome);
    observer.started(layout, truth, belief);

    for (int k = 1; k < problem.poses; ++k) {
        // Choose where to go, from what is believed.
        Command<Real> command = command_from<Real>(problem.control.fixed[k - 1]);
        if (controller == Controller::greedy)
            command = greedy_command(belief, problem.control, problem.filter, problem.sensor, layout, k,
                                     [&](int candidate, Real cost) { observer.cost(k, candidate, cost); });

        // The world moves on.
        move_features(truth, problem.world, features, k, noise);
        move_robot<Layout>(truth, problem.world, command, k, noise);

        // Predict.
        predict_robot(belief, problem.filter, layout, command);
        predict_features(belief, problem.filter, layout, k);

        // See.
        Rotation<Real> heading{};
        if constexpr (Layout::has_heading) heading = rotation(truth.heading);
        for (int j = 0; j < features; ++j)
            sightings[j] = look_at<Layout>(truth, heading, problem.sensor, k, j, noise);
        const auto edge_measurement = [&](int e) {
            return measure_edge(truth, problem.sensor, problem.filter.edges[e], k, e, noise);
        };
        observer.predicted(k, layout, truth, command, belief, sightings, edge_measurement);

        // Update, and compare with the truth.
        const UpdateResult<Real> result = update(belief, problem.filter, layout, sightings, edge_measurement);
        judge_step(problem, layout, belief, truth, result, k, sums, outcome, figures);
        observer.updated(k, layout, belief, figures);
    }
    write_columns(sums, outcome, problem.poses - 1, columns);
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
