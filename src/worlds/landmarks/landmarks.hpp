#pragma once
// The world of landmarks as one of the worlds.

#include "worlds/landmarks/problem.hpp"
#include "worlds/simulate.hpp"
#include <credence/detail/worlds.hpp>

#include <memory>
#include <string>

namespace credence {

inline const std::string landmark_world_name = "landmarks";

std::unique_ptr<const World> landmark_world();

/// A valid scenario as everything from the block up knows it, and back. The second throws InputError where the settings
/// are not those of the world of landmarks.
Scenario scenario_of(const LandmarkSettings& scenario);
LandmarkSettings landmark_settings_of(const Scenario& declared);

/// The trials of a valid scenario, on a unit.
class LandmarkSimulation : public Simulation {
public:
    explicit LandmarkSimulation(const LandmarkSettings& scenario, Target target = best_target());
    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t arm) const override;
    void simulate(std::size_t arm, const Batch& batch) const override;
    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override;
    CountedVariances counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const override;

private:
    LandmarkProblem problem_;
    Target target_;
    std::vector<Estimator> arms_;
    SimulationShape shape_;
};

}  // namespace credence
