#include "worlds/deformable/deformable.hpp"

#include "worlds/deformable/keys.hpp"

namespace credence {

namespace {

class DeformableDraft : public Draft {
public:
    void set(const std::string& key, const std::string& value) override { set_key(scenario_, key, value); }
    Scenario declare() const override {
        validate(scenario_);
        return scenario_of(resolved(scenario_));
    }

private:
    DeformableSettings scenario_;
};

/// A simulation with the problem that it reads.
class OwningSimulation : public Simulation {
public:
    explicit OwningSimulation(const DeformableSettings& scenario) : problem_(scenario), simulation_(problem_) {}
    const SimulationShape& shape() const override { return simulation_.shape(); }
    std::size_t workspace_size(std::size_t arm) const override { return simulation_.workspace_size(arm); }
    void simulate(std::size_t arm, const Batch& batch) const override { simulation_.simulate(arm, batch); }

private:
    Problem problem_;
    DeformableSimulation simulation_;
};

class DeformableWorld : public World {
public:
    std::string name() const override { return first_world; }
    std::vector<DescribedKey> keys() const override {
        std::vector<DescribedKey> described;
        const DeformableSettings defaults = resolved(DeformableSettings());
        for (const DeformableKey& key : scenario_keys())
            described.push_back({key.name, key.get(defaults), key.help, key.choices});
        return described;
    }
    std::unique_ptr<Draft> draft() const override { return std::make_unique<DeformableDraft>(); }
    std::vector<Column> columns(const Scenario& scenario) const override {
        return trial_columns(settings_of(scenario));
    }
    std::vector<Series> all_series(const Scenario& scenario) const override {
        return step_series(settings_of(scenario));
    }
    std::unique_ptr<const Simulation> simulation(const Scenario& scenario) const override {
        return std::make_unique<OwningSimulation>(settings_of(scenario));
    }
};

}  // namespace

std::unique_ptr<const World> deformable_world() { return std::make_unique<DeformableWorld>(); }

DeformableSimulation::DeformableSimulation(const Problem& problem, Target target)
    : problem_(problem), target_(std::move(target)), arms_(arms_of(problem.scenario())) {
    const ProblemView& view = problem.view();
    shape_ = {view.poses, view.state_size, column_count, view.series_count, view.group_count};
}

std::size_t DeformableSimulation::workspace_size(std::size_t arm) const {
    return target_.workspace_size(problem_.view(), arms_[arm].estimator);
}

void DeformableSimulation::simulate(std::size_t arm, const Batch& batch) const {
    target_.simulate(problem_.view(), arms_[arm], batch);
}

Block run_block(const Problem& problem, std::uint64_t root_seed, std::int64_t index, int trials, const Target& target) {
    const DeformableSimulation simulation(problem, target);
    return run_block(simulation, trial_columns(problem.scenario()), arms_of(problem.scenario()).size(), root_seed, index,
                     trials);
}

}  // namespace credence
