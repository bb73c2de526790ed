#include "worlds/explore/explore.hpp"

#include "engine/octets.hpp"
#include "worlds/deformable/deformable.hpp"
#include "worlds/values.hpp"
#include <credence/detail/world_of.hpp>

#include <algorithm>

namespace credence {

namespace {

std::string arm_name(const ExploreSettings& settings, const ExploreArm& arm) {
    if (arm.planner >= 0) return credence::arm_name(settings, {{}, arm.estimator, arm.planner});
    return explorer_names()[static_cast<std::size_t>(arm.controller)] + "." +
           estimator_names()[static_cast<std::size_t>(arm.estimator)];
}

/// The world as WorldOf takes it.
struct Explore {
    using Settings = ExploreSettings;

    std::string name() const { return explore_world_name; }
    const std::vector<ExploreKey>& keys() const { return explore_keys(); }
    Settings defaults() const { return credence::resolved(Settings()); }
    Settings resolved(const Settings& settings) const { return credence::resolved(settings); }
    void describe(const Settings& settings, Scenario& scenario) const {
        scenario.components = state_components(settings);
        scenario.groups = explore_groups(settings);
        for (const ExploreArm& arm : arms_of(settings)) scenario.arms.push_back(arm_name(settings, arm));
    }
    std::vector<DrawSource> sources(const Settings& settings) const {
        return drawn_sources(settings, settings.map == LandmarkMap::prior,
                             std::ranges::count(settings.explorers, Explorer::random) > 0);
    }
    std::vector<Column> columns(const Settings& settings, const Scenario&) const { return explore_columns(settings); }
    std::vector<Series> all_series(const Settings& settings, const Scenario&) const { return explore_series(settings); }
    std::unique_ptr<const Simulation> simulation(const Settings& settings, const Scenario&) const {
        return std::make_unique<ExploreSimulation>(settings);
    }
};

}  // namespace

std::unique_ptr<const World> explore_world() { return std::make_unique<WorldOf<Explore>>(); }

Scenario scenario_of(const ExploreSettings& settings) { return WorldOf<Explore>().scenario_of(settings); }

std::vector<ExploreArm> arms_of(const ExploreSettings& settings) {
    std::vector<ExploreArm> arms;
    for (const Explorer controller : settings.explorers)
        for (const Estimator estimator : *settings.arms.estimators) arms.push_back({controller, estimator});
    for (int planner = 0; planner < static_cast<int>(settings.arms.planners.size()); ++planner)
        for (const Estimator estimator : *settings.arms.estimators)
            arms.push_back({Explorer::fixed, estimator, planner});
    return arms;
}

ExploreSimulation::ExploreSimulation(const ExploreSettings& settings, Target target)
    : problem_(settings), target_(std::move(target)), arms_(arms_of(settings)) {
    const ExploreView& view = problem_.view();
    shape_ = {view.poses, view.state_size, explore_column_count + view.error_columns(), view.series_count,
              view.group_count};
}

std::size_t ExploreSimulation::workspace_size(std::size_t arm) const {
    return target_.explore_workspace_size(problem_.view(), arms_[arm]);
}

void ExploreSimulation::check_repeats(std::uint64_t root_seed) const {
    for (std::size_t arm = 0; arm < arms_.size(); ++arm)
        if (arms_[arm].planner >= 0)
            check_planner_repeats(*this, arm, arm_name(problem_.settings(), arms_[arm]), root_seed);
}

void ExploreSimulation::simulate(std::size_t arm, const Batch& batch) const {
    target_.simulate_explore(problem_.view(), arms_[arm], batch);
}

}  // namespace credence
