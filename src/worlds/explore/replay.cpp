#include "worlds/explore/explore.hpp"

#include "worlds/deformable/deformable.hpp"
#include "worlds/explore/pack_trial.hpp"
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

}  // namespace

Trajectory ExploreSimulation::replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                                     std::int64_t trial) const {
    const ExploreView& view = problem_.view();
    const ExploreSettings& settings = problem_.settings();
    Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], explore_columns(settings));
    trajectory.source = source_text(root_seed, trial);
    const SlamVariables variables =
        add_slam_variables(trajectory, settings, {}, "to this pose, as given to the filter");
    const bool plans = arms_[arm].controller == Explorer::greedy || arms_[arm].controller == Explorer::informed;
    ExploreRecorder recorder(view, variables, add_explore_variables(trajectory, settings, view.grid, plans),
                             trajectory);
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) *
                                   static_cast<std::size_t>(view.poses - 1));
    const auto cells = static_cast<std::size_t>(view.grid.count());
    const auto viewed = std::make_unique<bool[]>(cells);
    std::vector<int> queue(cells), from(cells);
    const KeyedDraws<double> draws(root_seed, static_cast<std::uint64_t>(trial), view.world.truncate);
    with_estimator<Process::heading>(arms_[arm].estimator, [&](auto estimator) {
        using Trial = ExploreTrial<double, decltype(estimator)>;
        std::vector<Command<double>> commands;
        if (const int planner = arms_[arm].planner; planner >= 0)
            commands = commands_of<Trial>(view, planner, root_seed, trial);
        const auto work = std::make_unique<ExploreWorkspaceOf<double, decltype(estimator)>>();
        work->viewed = viewed.get();
        work->queue = queue.data();
        work->from = from.data();
        run_trial(view, arms_[arm].controller, draws, recorder, *work, trajectory.column_values.data(),
                  all_series.data(), commands.empty() ? nullptr : commands.data());
    });
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

}  // namespace credence
