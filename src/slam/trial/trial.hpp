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

/// One trial of one arm, step by step: `start`, for each pose after the first one `control` and `step`, `finish`. All
/// of it is inlined: what a call could reach would have to stay in memory.
template <class Layout, class Real, class Estimating, class Noise, class Observer>
class Steps {
public:
    using Work = Workspace<Layout, Real, Estimating>;

    Steps(const ProblemView& problem, const Noise& noise, Observer& observer, Work& work)
        : problem_(problem), noise_(noise), observer_(observer), work_(work), layout_(problem.features),
          draws_(layout_) {}

    const Layout& layout() const { return layout_; }
    Work& work() { return work_; }

    /// Pose 0: every feature is initialised, whatever its range.
    CREDENCE_INLINE void start() {
        auto& truth = work_.truth;
        auto& belief = work_.belief;
        draw(0);
        start_truth(truth, problem_.world, layout_, draws_, noise_);
        look_first(truth, problem_.sensor, layout_.features(), measurement(), work_.sightings);
        start_belief(belief, problem_.filter, layout_, work_.sightings);
        Real error[Layout::capacity];
        estimation_error(belief, truth, layout_, error);
        sums_.pose_error = squared_pose_error<Layout>(error);
        sums_.position = truth.position;
        note_trouble(belief, layout_.size(), sums_.pose_error, all_lanes<Real>(), 0, outcome_);
        work_.estimator.start(layout_, belief, truth);
        observer_.started(layout_, truth, belief);
    }

    /// The control to pose k, from the belief.
    CREDENCE_INLINE Command<Real> control(Controller controller, int k) {
        const auto& belief = work_.belief;
        if (!plans(controller))
            return steered(controller, belief, problem_.control, problem_.filter, layout_, k, noise_);
        const Planning<Layout, Real> given{problem_.control, problem_.filter, problem_.sensor, layout_, work_.planner};
        const Command<Real> command = plan_ahead(belief, given, k, problem_.steps_ahead(controller, k), work_.horizon);
        observer_.planned(k, layout_, belief);
        return command;
    }

    CREDENCE_INLINE void step(int k, const Command<Real>& command, Real* all_series) {
        auto& truth = work_.truth;
        auto& belief = work_.belief;
        auto& sightings = work_.sightings;
        auto& estimator = work_.estimator;

        // Move the robot and the features.
        draw(k);
        move_features(truth, problem_.world, layout_, k, draws_);
        move_robot(truth, problem_.world, command, draws_);

        // Predict.
        estimator.predict(belief, problem_.filter, layout_, command, truth, k);

        // See.
        look(truth, problem_.sensor, layout_, k, measurement(), noise_, sightings);
        const auto edge_measurement = [&](int e) {
            return measure_edge(truth, problem_.sensor, problem_.filter.edges[e], k, e, noise_);
        };
        const auto linearised = estimator.linearised(belief, layout_, truth);
        gate_sightings(belief, problem_.filter, layout_, linearised, sightings);
        observer_.predicted(k, layout_, truth, command, belief, sightings, edge_measurement, linearised);

        // Update, and compare with the truth.
        estimator.update(belief, problem_.filter, layout_, sightings, edge_measurement, linearised, work_.update);
        evaluate_step(problem_, layout_, belief, truth, work_.update, k, work_.elimination, sums_, outcome_,
                      all_series);
        observer_.updated(k, layout_, belief, all_series);
    }

    CREDENCE_INLINE void finish(Real* columns) { write_columns(problem_, sums_, outcome_, columns); }

private:
    CREDENCE_INLINE Vector2<Real>* measurement() { return draws_.template of_features<Source::measurement>(); }
    CREDENCE_INLINE void draw(int k) {
        draws_.draw(noise_, k);
        shape_tails(problem_.sensor, layout_.features(), k, noise_, measurement());
    }

    const ProblemView& problem_;
    const Noise& noise_;
    Observer& observer_;
    Work& work_;
    Layout layout_;
    WorldDraws<Layout, Real> draws_;
    Sums<Real> sums_;
    Outcome<Real> outcome_;
};

/// One trial of one arm, by `controller` or, where they are given, by `commands` [K - 1]. Every value of `columns`
/// [column_count] and `series` [series_count, K - 1] is written.
template <class Layout, class Real, class Estimating, class Noise, class Observer>
void run_trial(const ProblemView& problem, Controller controller, const Noise& noise, Observer& observer,
               Workspace<Layout, Real, Estimating>& work, Real* columns, Real* all_series,
               const Command<Real>* commands = nullptr) {
    Steps<Layout, Real, Estimating, Noise, Observer> trial(problem, noise, observer, work);
    trial.start();
    for (int k = 1; k < problem.poses; ++k)
        trial.step(k, commands != nullptr ? commands[k - 1] : trial.control(controller, k), all_series);
    trial.finish(columns);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
