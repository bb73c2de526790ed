#include "worlds/landmarks/landmarks.hpp"

#include "slam/estimators/estimators.hpp"
#include "worlds/landmarks/trial.hpp"
#include "worlds/counted.hpp"
#include "worlds/slam_recorder.hpp"

#include <limits>
#include <memory>

namespace credence {

Trajectory LandmarkSimulation::replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                                      std::int64_t trial) const {
    const LandmarkView& view = problem_.view();
    const SlamState state = state_of(landmark_settings_of(scenario));
    Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], trial_columns(state));
    trajectory.source = source_text(root_seed, trial);
    SlamRecorder recorder(view, add_slam_variables(trajectory, state, {}, "to this pose, as given to the filter"),
                          trajectory);
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) *
                                   static_cast<std::size_t>(view.poses - 1));
    const KeyedDraws<double> draws(root_seed, static_cast<std::uint64_t>(trial),
                                   std::numeric_limits<double>::infinity(), view.other);
    with_estimator<Process::heading>(arms_[arm], [&](auto estimator) {
        using StateLayout = Layout<Process::heading, any_count>;
        using Estimating = typename decltype(estimator)::template type<StateLayout, double>;
        const auto work = std::make_unique<CommonWorkspace<StateLayout, double, Estimating>>();
        run_trial(view, draws, recorder, *work, trajectory.column_values.data(), all_series.data());
    });
    fill_failed(trajectory.columns, trajectory.column_values.data());
    return trajectory;
}

CountedVariances LandmarkSimulation::counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const {
    const LandmarkView& view = problem_.view();
    std::vector<double> all_series(static_cast<std::size_t>(view.series_count) *
                                   static_cast<std::size_t>(view.poses - 1));
    return with_estimator<Process::heading>(arms_[arm], [&](auto estimator) {
        using StateLayout = Layout<Process::heading, any_count>;
        using Estimating = Attributed<typename decltype(estimator)::template type<StateLayout, double>, StateLayout>;
        const auto work = std::make_unique<CommonWorkspace<StateLayout, double, Estimating>>();
        return count_variances(view, counted_sources(view.filter, 0, "start"), work->estimator, trials, column_count,
                               [&](std::int64_t trial, auto& observer, double* columns) {
            const KeyedDraws<double> draws(root_seed, static_cast<std::uint64_t>(trial),
                                           std::numeric_limits<double>::infinity(), view.other);
            run_trial(view, draws, observer, *work, columns, all_series.data());
        });
    });
}

}  // namespace credence
