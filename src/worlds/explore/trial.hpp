#pragma once
// One trial of one arm in the world `explore`, pose by pose [docs/explore.md]. It reads like slam/trial/trial.hpp, and
// shares with it layout, belief, estimators, update, evaluation and observers.

#include "slam/trial/workspace.hpp"
#include "worlds/explore/frontier.hpp"
#include "worlds/explore/horizon.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The workspace of one trial; its pointers lead to memory behind it.
template <class Real, class Estimating>
struct ExploreWorkspace : CommonWorkspace<ExploreLayout, Real, Estimating>, ExploreState<Real> {};

/// What is drawn at a pose.
template <class Real>
using ExploreDraws = PoseDraws<ExploreLayout, Real, Source::measurement>;

/// Sums over the steps of one trial, beside those of every world.
template <class Real>
struct ExploreSums {
    Real nees = Real(0);        ///< times the whole dimension over that of what is there
    Real dimensions = Real(0);  ///< of what is there
    Real discovered = Real(0), coverage = Real(0), collisions = Real(0);
};

template <class Real>
Real one_where(Mask<Real> mask) { return select(mask, Real(1), Real(0)); }

/// Sees the landmarks of pose k, and sets aside the first sights: what is not known yet has no place in the update.
/// `first` [M]. Returns how many those are.
template <class Real, class Estimating, class Draws, class Noise>
Real look_around(const ExploreView& problem, const ExploreLayout& layout, int k, const Draws& draws,
                 const Noise& noise, ExploreWorkspace<Real, Estimating>& work, Mask<Real>* first) {
    const auto& truth = work.truth;
    look(truth, problem.sensor, layout, k, draws.template of_features<Source::measurement>(), noise, work.sightings);
    Real count(0);
    for (int j = 0; j < layout.features(); ++j) {
        Mask<Real>& seen = work.sightings[j].seen;
        const Vector2<Real> way = truth.feature[j] - truth.position;
        if (any(seen)) seen = both(seen, in_sight(problem, truth.position, truth.rotation, way, squared_norm(way)));
        first[j] = both(seen, negated(work.mapped[j]));
        seen = both(seen, work.mapped[j]);
        count = count + one_where<Real>(first[j]);
    }
    return count;
}

/// The landmarks of first sights enter the state.
template <class Real, class Estimating>
void initialise_landmarks(const ExploreView& problem, const ExploreLayout& layout, const Mask<Real>* first,
                          ExploreWorkspace<Real, Estimating>& work) {
    for (int j = 0; j < layout.features(); ++j) {
        if (!any(first[j])) continue;
        work.sightings[j].seen = first[j];
        work.estimator.initialise(work.belief, problem.filter, layout, j, work.sightings[j], work.truth);
        work.mapped[j] = either(work.mapped[j], first[j]);
    }
}

/// The truth at pose 0, and the belief about it: landmarks at the place of their first estimate. One that is absent is
/// at its true place with next to no variance, so that it has no error and no part in anything.
template <class Real, class Estimating, class Draws, class Noise>
void start_trial(const ExploreView& problem, const ExploreLayout& layout, Draws& draws, const Noise& noise,
                 ExploreWorkspace<Real, Estimating>& work) {
    using State = ExploreLayout;
    const WorldParameters& world = problem.world;
    auto& truth = work.truth;
    auto& belief = work.belief;
    truth.heading = Real(world.sigma_initial_heading) * draws.heading();
    truth.rotation = rotation(truth.heading);
    truth.position = add_scaled({Real(0), Real(0)}, Real(world.sigma_initial_position), draws.position());
    const Vector2<Real>* measured = draws.template of_features<Source::measurement>();
    for (int j = 0; j < layout.features(); ++j) {
        truth.feature[j] = truth.centre[j] = first_place<Real>(world, j, noise);
        const Real prior = Real(problem.prior);
        work.sightings[j] = {Mask<Real>{},
                             problem.map == LandmarkMap::prior
                                 ? add_scaled(truth.feature[j], prior, noise.normal(Source::landmark_prior, 0, j))
                                 : truth.feature[j],
                             prior};
        work.mapped[j] = problem.map == LandmarkMap::known ? all_lanes<Real>() : negated(all_lanes<Real>());
    }
    if (problem.map == LandmarkMap::known)
        look_first(truth, problem.sensor, layout.features(), measured, work.sightings);
    start_belief(belief, problem.filter, layout, work.sightings);
    auto& P = belief.covariance.entry;
    for (int i = State::pose_size; problem.map != LandmarkMap::known && i < layout.size(); ++i)
        P[i][i] = Real(problem.map == LandmarkMap::prior ? problem.prior * problem.prior : absent_variance);
    work.estimator.start(layout, belief, truth);
    if (problem.map == LandmarkMap::known) return;
    Mask<Real> first[State::feature_capacity];
    look_around(problem, layout, 0, draws, noise, work, first);
    initialise_landmarks(problem, layout, first, work);
}

/// Writes the series of step k that only this world has, and brings the NEES of what is there to the whole dimension.
template <class Real, class Estimating>
void add_own_series(const ExploreView& problem, const ExploreLayout& layout, int k,
                    const ExploreWorkspace<Real, Estimating>& work, Mask<Real> stopped, ExploreSums<Real>& sums,
                    Real* all_series) {
    const auto series = [&](int f) -> Real& { return all_series[f * (problem.poses - 1) + k - 1]; };
    constexpr int pose = ExploreLayout::pose_size;
    Real dimension = Real(pose);
    sums.discovered = Real(0);
    for (int j = 0; j < layout.features(); ++j) {
        dimension = dimension + select(work.present(problem, j), Real(2), Real(0));
        sums.discovered = sums.discovered + one_where<Real>(work.mapped[j]);
    }
    const auto stretch = [&](int f, int whole, const Real& there) {
        series(f) = select(there > Real(0), series(f) * (Real(whole) / there), Real(whole));
    };
    if (problem.map == LandmarkMap::none) {
        stretch(ExploreLayout::group_all, layout.size(), dimension);
        stretch(ExploreLayout::group_features, 2 * layout.features(), dimension - Real(pose));
        if (problem.chart_series >= 0) stretch(problem.chart_series, layout.size(), dimension);
    }
    sums.nees = sums.nees + series(0);
    sums.dimensions = sums.dimensions + dimension;
    sums.collisions = sums.collisions + one_where<Real>(stopped);
    series(problem.own_series + series_dimension) = dimension;
    series(problem.own_series + series_unsettled) = work.update.unsettled;
    series(problem.own_series + series_discovered) = sums.discovered;
    series(problem.own_series + series_coverage) = sums.coverage;
    series(problem.own_series + series_collisions) = one_where<Real>(stopped);
}

/// The columns in the order of ExploreColumn. The log score is that of what is there.
template <class Real>
void write_columns(const ExploreView& problem, Sums<Real> sums, const ExploreSums<Real>& own, Outcome<Real>& outcome,
                   Real* columns) {
    const int steps = problem.poses - 1;
    const Real score_of = sums.nees, absent = Real(steps * problem.state_size) - own.dimensions;
    sums.nees = own.nees;
    write_columns(problem, sums, outcome, columns);
    const Real mean_dimension = own.dimensions / Real(steps);
    const Real determinants = fnma(absent, log(Real(absent_variance)), sums.determinants.log());
    columns[column_log_score] =
        Real(0.5) * (mean_dimension * Real(log_two_pi + problem.filter.log_covariance_factor) +
                     (determinants + score_of) / Real(steps));
    columns[column_discovered] = own.discovered;
    columns[column_coverage] = own.coverage;
    columns[column_collisions] = own.collisions;
    columns[explore_column_count - 2] = outcome.status;
    columns[explore_column_count - 1] = outcome.pose;
}

/// One trial of one arm, step by step: `start`, for each pose after the first one `control` and `step`, `finish`.
template <class Real, class Estimating, class Noise, class Observer>
class ExploreSteps {
public:
    using State = ExploreLayout;
    using Work = ExploreWorkspace<Real, Estimating>;

    ExploreSteps(const ExploreView& problem, const Noise& noise, Observer& observer, Work& work)
        : problem_(problem), noise_(noise), observer_(observer), work_(work),
          layout_(problem.features, problem.group_count), draws_(layout_) {}

    const State& layout() const { return layout_; }
    Work& work() { return work_; }

    void start() {
        const auto& truth = work_.truth;
        const auto& belief = work_.belief;
        draw(0);
        for (int i = 0; i < problem_.grid.count(); ++i) work_.viewed[i] = negated(all_lanes<Real>());
        start_trial(problem_, layout_, draws_, noise_, work_);
        own_.coverage = view_cells(problem_, truth.position, truth.rotation, work_.viewed);
        Real error[State::capacity];
        estimation_error(belief, truth, layout_, error);
        sums_.pose_error = squared_pose_error<State>(error);
        sums_.position = truth.position;
        note_trouble(belief, layout_.size(), sums_.pose_error, all_lanes<Real>(), 0, outcome_);
        observer_.started(layout_, truth, belief);
        observer_.explored(0, work_);
    }

    /// The control to pose k; `informed` alone reads the truth.
    Command<Real> control(Explorer controller, int k) {
        switch (controller) {
            case Explorer::frontier: return towards_frontier(problem_, work_.belief, work_);
            case Explorer::random:
                return fetch_each(problem_.control, noise_.uniform(Source::control, k, 0) *
                                                        Real(problem_.control.candidate_count));
            case Explorer::horizon:
                return plan_among_walls(problem_, work_.belief, work_.truth, layout_, k, work_, priced(k));
            case Explorer::greedy:
            case Explorer::informed: {
                ExplorePlanner planner(problem_, controller == Explorer::informed, work_.belief, work_.truth, layout_,
                                       k, work_);
                return planner.choose(priced(k));
            }
            default: return command_from<Real>(problem_.control.waypoints[k - 1]);
        }
    }

    void step(int k, const Command<Real>& command, Real* all_series) {
        auto& truth = work_.truth;
        auto& belief = work_.belief;
        auto& estimator = work_.estimator;
        const auto no_edge = [](int) { return Vector2<Real>{}; };

        // Move the robot, and predict.
        draw(k);
        const Mask<Real> stopped = move_among_walls<State>(truth, problem_, command, draws_);
        const Command<Real> told = reported(problem_, command, draws_);
        estimator.predict(belief, problem_.filter, layout_, told, truth, k);

        // See.
        Mask<Real> first[State::feature_capacity];
        const Real first_sights = look_around(problem_, layout_, k, draws_, noise_, work_, first);
        own_.coverage = own_.coverage + view_cells(problem_, truth.position, truth.rotation, work_.viewed);
        const auto linearised = estimator.linearised(belief, layout_, truth);
        gate_sightings(belief, problem_.filter, layout_, linearised, work_.sightings);
        observer_.predicted(k, layout_, truth, told, belief, work_.sightings, no_edge, linearised);

        // Update with the landmarks that are known, initialise those that are new, and compare with the truth.
        estimator.update(belief, problem_.filter, layout_, work_.sightings, no_edge, linearised, work_.update);
        initialise_landmarks(problem_, layout_, first, work_);
        work_.update.unseen = work_.update.unseen - first_sights;
        evaluate_step(problem_, layout_, belief, truth, work_.update, k, work_.elimination, sums_, outcome_,
                      all_series);
        add_own_series(problem_, layout_, k, work_, stopped, own_, all_series);
        observer_.updated(k, layout_, belief, all_series);
        observer_.explored(k, work_);
    }

    void finish(Real* columns) { write_columns(problem_, sums_, own_, outcome_, columns); }

private:
    auto priced(int k) {
        return [this, k](int i, double cost, bool allowed) { observer_.priced(k, i, cost, allowed); };
    }
    void draw(int k) {
        draws_.draw(noise_, k);
        shape_tails(problem_.sensor, layout_.features(), k, noise_,
                    draws_.template of_features<Source::measurement>());
    }

    const ExploreView& problem_;
    const Noise& noise_;
    Observer& observer_;
    Work& work_;
    State layout_;
    ExploreDraws<Real> draws_;
    Sums<Real> sums_;
    ExploreSums<Real> own_;
    Outcome<Real> outcome_;
};

/// One trial of one arm, by `controller` or, where they are given, by `commands` [K - 1]. `columns`
/// [explore_column_count]; `series` [series_count, K - 1]; both are written whole.
template <class Real, class Estimating, class Noise, class Observer>
void run_trial(const ExploreView& problem, Explorer controller, const Noise& noise, Observer& observer,
               ExploreWorkspace<Real, Estimating>& work, Real* columns, Real* all_series,
               const Command<Real>* commands = nullptr) {
    ExploreSteps<Real, Estimating, Noise, Observer> trial(problem, noise, observer, work);
    trial.start();
    for (int k = 1; k < problem.poses; ++k)
        trial.step(k, commands != nullptr ? commands[k - 1] : trial.control(controller, k), all_series);
    trial.finish(columns);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
