#include "worlds/explore/explore.hpp"

#include "worlds/deformable/deformable.hpp"
#include "worlds/explore/single_workspace.hpp"
#include "worlds/single_trials.hpp"
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

/// Calls use(single) with the SingleTrials of an arm.
template <class Use>
auto with_single_trials(const ExploreView& view, const ExploreArm& arm, const Use& use) {
    return with_estimator<Process::heading>(arm.estimator, [&](auto estimator) {
        using Estimating = typename decltype(estimator)::template type<ExploreLayout, double>;
        using Work = SingleWorkspace<Attributed<Estimating, ExploreLayout>>;
        SingleTrials<ExploreRecorder, ExploreView, Explorer, Work> single(view, arm.controller,
                                                                          std::make_unique<Work>(view));
        return use(single);
    });
}

TrialInputs<KeyedDraws<double>> inputs_of(const ExploreView& view, const ExploreArm& arm, const Target& target,
                                          std::uint64_t root_seed, std::int64_t trial) {
    return {{root_seed, static_cast<std::uint64_t>(trial), view.world.truncate, view.other},
            commands_of(target.explore_workspace_size, target.simulate_explore, view, arm, root_seed, trial)};
}

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
    with_single_trials(view, arms_[arm], [&](auto& single) {
        single.record(inputs_of(view, arms_[arm], target_, root_seed, trial), recorder,
                      trajectory.column_values.data());
    });
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

CountedVariances ExploreSimulation::counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const {
    const ExploreView& view = problem_.view();
    const std::vector<CountedSource> sources =
        counted_sources(view.filter, 0, view.map == LandmarkMap::known ? "measurement" : "start");
    return with_single_trials(view, arms_[arm], [&](auto& single) {
        return single.count(sources, trials, explore_column_count, [&](std::int64_t trial) {
            return inputs_of(view, arms_[arm], target_, root_seed, trial);
        });
    });
}

}  // namespace credence
