#include "worlds/explore/explore.hpp"

#include "worlds/deformable/deformable.hpp"
#include "worlds/explore/pack_trial.hpp"
#include "worlds/counted.hpp"
#include "worlds/slam_recorder.hpp"

#include <limits>
#include <memory>

namespace credence {

namespace {

/// What a trajectory of this world has beside those of every SLAM trial, as places in Trajectory::variables.
struct ExploreVariables {
    std::size_t in_state, cell_viewed, cost;
};

ExploreVariables add_explore_variables(Trajectory& trajectory, const ExploreSettings& settings, const CellGrid& grid,
                                       bool plans) {
    const auto dimension = [&](const char* name, const char* what, int size) {
        trajectory.dimensions.push_back({name, what, static_cast<std::size_t>(size)});
    };
    dimension("cell_row", "row of the grid, from below", grid.rows);
    dimension("cell_column", "column of the grid", grid.columns);
    return {trajectory.add({"in_state", "whether the landmark is in the state after the update", "1",
                            {"pose", "feature"}, TrajectoryNumbers::flag, "unknown absent present"}),
            trajectory.add({"cell_viewed", "pose at which the cell was first in sight; -1 where it never was", "1",
                            {"cell_row", "cell_column"}, TrajectoryNumbers::integer}),
            plans ? add_candidates(trajectory, settings) : 0};
}

/// The recorder of a trial. What is absent from the state is NaN.
class ExploreRecorder : public SlamRecorder {
public:
    ExploreRecorder(const ExploreView& problem, const SlamVariables& variables, const ExploreVariables& own,
                    Trajectory& trajectory)
        : SlamRecorder(problem, variables, trajectory), problem_(problem), shared_(variables), own_(own) {}

    void priced(int k, int candidate, double cost, bool allowed) {
        if (allowed) to(own_.cost, k)[candidate] = cost;
    }

    void explored(int k, const ExploreState<double>& state) {
        for (int j = 0; j < problem_.features; ++j) {
            to(own_.in_state, k)[j] = state.present(problem_, j);
            forget_absent(to(own_.in_state, k)[j], j, shared_.mean, shared_.covariance, k);
            if (k > 0)
                forget_absent(to(own_.in_state, k - 1)[j], j, shared_.predicted_mean, shared_.predicted_covariance, k);
        }
        for (int i = 0; i < problem_.grid.count(); ++i)
            if (double& first = to(own_.cell_viewed, 0)[i]; first < 0 && state.viewed[i]) first = k;
    }

private:
    void forget_absent(double present, int feature, std::size_t mean, std::size_t covariance, int k) {
        const int n = problem_.state_size, at = ExploreLayout::feature(feature);
        if (present != 0) return;
        for (int i = at; i < at + 2; ++i) {
            to(mean, k)[i] = nan;
            for (int j = 0; j < n; ++j) to(covariance, k)[i * n + j] = to(covariance, k)[j * n + i] = nan;
        }
    }

    const ExploreView& problem_;
    SlamVariables shared_;
    ExploreVariables own_;
};

/// The workspace of single trials, with room for the cells and for the series.
template <class Estimating>
class SingleTrials {
public:
    explicit SingleTrials(const ExploreView& view)
        : view_(view),
          viewed_(std::make_unique<bool[]>(static_cast<std::size_t>(view.grid.count() * view.control.horizon))),
          queue_(static_cast<std::size_t>(view.grid.count())), from_(queue_.size()),
          ahead_(static_cast<std::size_t>(view.control.horizon)),
          all_series_(static_cast<std::size_t>(view.series_count) * static_cast<std::size_t>(view.poses - 1)) {
        work_->viewed = viewed_.get();
        work_->queue = queue_.data();
        work_->from = from_.data();
        work_->ahead = ahead_.data();
    }
    Estimating& estimator() { return work_->estimator; }
    template <class Observer>
    void run(Explorer controller, const std::vector<Command<double>>& commands, std::uint64_t root_seed,
             std::int64_t trial, Observer& observer, double* columns) {
        const KeyedDraws<double> draws(root_seed, static_cast<std::uint64_t>(trial), view_.world.truncate,
                                       view_.other);
        run_trial(view_, controller, draws, observer, *work_, columns, all_series_.data(),
                  commands.empty() ? nullptr : commands.data());
    }

private:
    const ExploreView& view_;
    std::unique_ptr<bool[]> viewed_;
    std::vector<int> queue_, from_;
    std::vector<Belief<double, ExploreLayout::capacity>> ahead_;
    std::vector<double> all_series_;
    std::unique_ptr<ExploreWorkspace<double, Estimating>> work_ =
        std::make_unique<ExploreWorkspace<double, Estimating>>();
};

}  // namespace

Trajectory ExploreSimulation::replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                                     std::int64_t trial) const {
    const ExploreView& view = problem_.view();
    const ExploreSettings& settings = problem_.settings();
    Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], explore_columns(settings));
    trajectory.source = source_text(root_seed, trial);
    const SlamVariables variables =
        add_slam_variables(trajectory, settings, {}, "to this pose, as given to the filter");
    const ExploreVariables own =
        add_explore_variables(trajectory, settings, view.grid, plans(arms_[arm].controller));
    ExploreRecorder recorder(view, variables, own, trajectory);
    with_estimator<Process::heading>(arms_[arm].estimator, [&](auto estimator) {
        using Estimating = typename decltype(estimator)::template type<ExploreLayout, double>;
        using Trial = ExploreTrial<double, decltype(estimator)>;
        SingleTrials<Estimating>(view).run(arms_[arm].controller,
                                           commands_of<Trial>(view, arms_[arm].planner, root_seed, trial), root_seed,
                                           trial, recorder, trajectory.column_values.data());
    });
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

CountedVariances ExploreSimulation::counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const {
    const ExploreView& view = problem_.view();
    const std::vector<CountedSource> sources =
        counted_sources(view.filter, 0, view.map == LandmarkMap::known ? "measurement" : "start");
    return with_estimator<Process::heading>(arms_[arm].estimator, [&](auto estimator) {
        using Estimating =
            Attributed<typename decltype(estimator)::template type<ExploreLayout, double>, ExploreLayout>;
        SingleTrials<Estimating> single(view);
        return count_variances(view, sources, single.estimator(), trials, explore_column_count,
                               [&](std::int64_t trial, auto& observer, double* columns) {
            using Trial = ExploreTrial<double, decltype(estimator)>;
            single.run(arms_[arm].controller, commands_of<Trial>(view, arms_[arm].planner, root_seed, trial), root_seed,
                       trial, observer, columns);
        });
    });
}

}  // namespace credence
