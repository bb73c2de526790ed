#include "worlds/landmarks/landmarks.hpp"

#include "worlds/values.hpp"

#include "worlds/landmarks/keys.hpp"

#include <credence/detail/world_of.hpp>

namespace credence {

namespace {

/// The world of landmarks as WorldOf takes it.
struct Landmarks {
    using Settings = LandmarkSettings;

    std::string name() const { return landmark_world_name; }
    const std::vector<LandmarkKey>& keys() const { return landmark_keys(); }
    Settings defaults() const { return {}; }
    Settings resolved(const Settings& settings) const {
        validate(settings);
        return settings;
    }
    void describe(const Settings& settings, Scenario& scenario) const {
        const SlamState state = state_of(settings);
        scenario.components = state_components(state);
        scenario.groups = state_groups(state);
        for (const Estimator estimator : settings.estimators)
            scenario.arms.push_back("fixed." + estimator_names()[static_cast<std::size_t>(estimator)]);
    }
    std::vector<DrawSource> sources(const Settings&) const { return landmark_sources(); }
    std::vector<Column> columns(const Settings& settings, const Scenario&) const {
        return trial_columns(state_of(settings));
    }
    std::vector<Series> all_series(const Settings& settings, const Scenario&) const {
        return landmark_series(settings);
    }
    std::unique_ptr<const Simulation> simulation(const Settings& settings, const Scenario&) const {
        return std::make_unique<LandmarkSimulation>(settings);
    }
};

}  // namespace

std::unique_ptr<const World> landmark_world() { return std::make_unique<WorldOf<Landmarks>>(); }

Scenario scenario_of(const LandmarkSettings& settings) { return WorldOf<Landmarks>().scenario_of(settings); }

LandmarkSettings landmark_settings_of(const Scenario& scenario) { return WorldOf<Landmarks>().settings_of(scenario); }

LandmarkSimulation::LandmarkSimulation(const LandmarkSettings& scenario, Target target)
    : problem_(scenario), target_(std::move(target)), arms_(scenario.estimators) {
    const LandmarkView& view = problem_.view();
    shape_ = {view.poses, view.state_size, column_count + view.error_columns(), view.series_count, view.group_count};
}

std::size_t LandmarkSimulation::workspace_size(std::size_t arm) const {
    return target_.landmarks_workspace_size(problem_.view(), arms_[arm]);
}

void LandmarkSimulation::simulate(std::size_t arm, const Batch& batch) const {
    target_.simulate_landmarks(problem_.view(), arms_[arm], batch);
}

}  // namespace credence
