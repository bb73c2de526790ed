#include "worlds/landmarks/landmarks.hpp"

#include <credence/error.hpp>

#include "worlds/landmarks/keys.hpp"
#include "worlds/values.hpp"

namespace credence {

namespace {

class LandmarkDraft : public Draft {
public:
    void set(const std::string& key, const std::string& value) override {
        set_one_of(landmark_keys(), scenario_, key, value);
    }
    Scenario declare() const override {
        validate(scenario_);
        return scenario_of(scenario_);
    }

private:
    LandmarkSettings scenario_;
};

class LandmarkWorld : public World {
public:
    std::string name() const override { return landmark_world_name; }
    std::vector<DescribedKey> keys() const override {
        std::vector<DescribedKey> described;
        const LandmarkSettings defaults;
        for (const LandmarkKey& key : landmark_keys())
            described.push_back({key.name, key.get(defaults), key.help, key.choices});
        return described;
    }
    std::unique_ptr<Draft> draft() const override { return std::make_unique<LandmarkDraft>(); }
    std::vector<Column> columns(const Scenario& scenario) const override {
        return trial_columns(reported_as(landmark_scenario_of(scenario)));
    }
    std::vector<Series> all_series(const Scenario& scenario) const override {
        return landmark_series(landmark_scenario_of(scenario));
    }
    std::unique_ptr<const Simulation> simulation(const Scenario& scenario) const override {
        return std::make_unique<LandmarkSimulation>(landmark_scenario_of(scenario));
    }
};

}  // namespace

std::unique_ptr<const World> landmark_world() { return std::make_unique<LandmarkWorld>(); }

Scenario scenario_of(const LandmarkSettings& scenario) {
    const DeformableSettings slam = reported_as(scenario);
    Scenario declared{landmark_world_name, scenario.name, scenario.title, scenario.length_unit, scenario.poses,
                         {{world_key, landmark_world_name}}, state_components(slam), state_blocks(slam), {}};
    for (const LandmarkKey& key : landmark_keys()) declared.settings.push_back({key.name, key.get(scenario)});
    for (const Estimator estimator : scenario.estimators) declared.arms.push_back(arm_name({Controller::fixed, estimator}));
    return declared;
}

LandmarkSettings landmark_scenario_of(const Scenario& declared) {
    LandmarkSettings scenario;
    for (const Setting& setting : declared.settings)
        if (setting.key != world_key) set_one_of(landmark_keys(), scenario, setting.key, setting.value);
    validate(scenario);
    return scenario;
}

LandmarkSimulation::LandmarkSimulation(const LandmarkSettings& scenario, Target target)
    : problem_(scenario), target_(std::move(target)), arms_(scenario.estimators) {
    const LandmarkView& view = problem_.view();
    shape_ = {view.poses, view.state_size, column_count, view.series_count, view.group_count};
}

std::size_t LandmarkSimulation::workspace_size(std::size_t arm) const {
    return target_.landmarks_workspace_size(problem_.view(), arms_[arm]);
}

void LandmarkSimulation::simulate(std::size_t arm, const Batch& batch) const {
    target_.simulate_landmarks(problem_.view(), arms_[arm], batch);
}

}  // namespace credence
