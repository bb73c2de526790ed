#pragma once
// The world `explore` as one of the worlds.

#include "worlds/explore/problem.hpp"
#include "worlds/simulate.hpp"
#include <credence/detail/keys.hpp>
#include <credence/detail/worlds.hpp>

#include <memory>
#include <string>

namespace credence {

inline const std::string explore_world_name = "explore";

std::unique_ptr<const World> explore_world();

using ExploreKey = KeyOf<ExploreSettings>;

/// All keys but scenario.world, grouped by section, in the order in which they are shown.
const std::vector<ExploreKey>& explore_keys();

/// A valid scenario as everything from the block up knows it.
Scenario scenario_of(const ExploreSettings& settings);

/// The trials of resolved settings, on a unit.
class ExploreSimulation : public Simulation {
public:
    explicit ExploreSimulation(const ExploreSettings& settings, Target target = best_target());
    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t arm) const override;
    void simulate(std::size_t arm, const Batch& batch) const override;
    void check_repeats(std::uint64_t root_seed) const override;
    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override;
    CountedVariances counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const override;

private:
    ExploreProblem problem_;
    Target target_;
    std::vector<ExploreArm> arms_;
    SimulationShape shape_;
};

}  // namespace credence
