#include "worlds/deformable/deformable.hpp"

#include "engine/octets.hpp"

#include <credence/detail/world_of.hpp>
#include <credence/error.hpp>
#include "worlds/values.hpp"

#include <map>

namespace credence {

namespace {

/// The deformable world as WorldOf takes it.
struct Deformable {
    using Settings = DeformableSettings;

    std::string name() const { return first_world; }
    const std::vector<DeformableKey>& keys() const { return scenario_keys(); }
    Settings defaults() const { return credence::resolved(Settings()); }
    Settings resolved(const Settings& settings) const {
        validate(settings);
        return credence::resolved(settings);
    }
    void describe(const Settings& settings, Scenario& scenario) const {
        scenario.components = state_components(settings);
        scenario.groups = state_groups(settings);
        for (const Arm& arm : arms_of(settings)) scenario.arms.push_back(arm_name(settings, arm));
    }
    std::vector<DrawSource> sources(const Settings& settings) const {
        return drawn_sources(settings, false, has_arm(settings, Controller::random));
    }
    std::vector<Column> columns(const Settings& settings, const Scenario&) const { return trial_columns(settings); }
    std::vector<Series> all_series(const Settings& settings, const Scenario&) const { return step_series(settings); }
    std::unique_ptr<const Simulation> simulation(const Settings& settings, const Scenario&) const {
        return std::make_unique<DeformableSimulation>(std::make_shared<const Problem>(settings));
    }
};

}  // namespace

std::vector<DrawSource> drawn_sources(const DeformableSettings& settings, bool prior, bool control) {
    const NoiseSettings& noise = settings.noise;
    const std::map<std::string, bool> drawn{
        {"start", prior || noise.initial_heading > 0 || noise.initial_position > 0},
        {"odometry", noise.odometry > 0},
        {"heading", settings.process == Process::heading && noise.heading > 0},
        {"measurement", true},
        {"walk", noise.walk > 0},
        {"deformation", noise.deformation > 0},
        {"edges", settings.truth.edge_noise == EdgeNoise::independent},
        {"detection", settings.sensor.detection < 1},
        {"outliers", noise.measurement_tails == Tails::contaminated},
        {"placement", settings.features.placement != Placement::given},
        {"bias", noise.odometry_bias > 0},
        {"control", control}};
    std::vector<DrawSource> sources = slam_sources();
    std::erase_if(sources, [&](const DrawSource& source) { return !drawn.at(source.name); });
    return sources;
}

std::unique_ptr<const World> deformable_world() { return std::make_unique<WorldOf<Deformable>>(); }

Scenario scenario_of(const DeformableSettings& settings) { return WorldOf<Deformable>().scenario_of(settings); }

DeformableSettings settings_of(const Scenario& scenario) {
    if (scenario.world != first_world)
        throw invalid_value(world_key, scenario.world, "noise is recorded for the deformable world",
                            "Give a scenario of that world");
    return WorldOf<Deformable>().settings_of(scenario);
}

DeformableSimulation::DeformableSimulation(std::shared_ptr<const Problem> problem, Target target)
    : problem_(std::move(problem)), target_(std::move(target)), arms_(arms_of(problem_->scenario())) {
    const ProblemView& view = problem_->view();
    shape_ = {view.poses, view.state_size, column_count + view.error_columns(), view.series_count, view.group_count};
}

std::size_t DeformableSimulation::workspace_size(std::size_t arm) const {
    return target_.workspace_size(problem_->view(), arms_[arm]);
}

void DeformableSimulation::simulate(std::size_t arm, const Batch& batch) const {
    target_.simulate(problem_->view(), arms_[arm], batch);
}

void DeformableSimulation::check_repeats(std::uint64_t root_seed) const {
    for (std::size_t arm = 0; arm < arms_.size(); ++arm)
        if (arms_[arm].planner >= 0)
            check_planner_repeats(*this, arm, arm_name(problem_->scenario(), arms_[arm]), root_seed);
}

Trajectory DeformableSimulation::replay(const Scenario&, std::size_t arm, std::uint64_t root_seed,
                                        std::int64_t trial) const {
    return replay_trial(*problem_, arms_[arm], root_seed, trial, target_);
}

Block run_block(const Problem& problem, std::uint64_t root_seed, std::int64_t index, int trials, const Target& target) {
    const DeformableSimulation simulation(problem, target);
    return run_block(simulation, trial_columns(problem.scenario()), arms_of(problem.scenario()).size(), root_seed,
                     index, trials);
}

}  // namespace credence
