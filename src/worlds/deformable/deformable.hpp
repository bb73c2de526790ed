#pragma once
// The deformable world of the document as one of the worlds.

#include <credence/detail/block.hpp>
#include <credence/detail/recorded_noise.hpp>
#include "slam/trial/problem.hpp"
#include "worlds/simulate.hpp"

#include <memory>

namespace credence {

std::unique_ptr<const World> deformable_world();

/// Settings as engine, files and program know them, and back. Both throw InputError where settings contradict each
/// other, the second also where they are not those of the deformable world.
Scenario scenario_of(const DeformableSettings& settings);
DeformableSettings settings_of(const Scenario& scenario);

/// The sources that trials of these settings draw from. `prior`, `control`: whether a prior of landmarks and controls
/// are drawn, too.
std::vector<DrawSource> drawn_sources(const DeformableSettings& settings, bool prior, bool control);

/// The trials of a problem on a unit.
class DeformableSimulation : public Simulation {
public:
    explicit DeformableSimulation(std::shared_ptr<const Problem> problem, Target target = best_target());
    /// The problem must outlive it.
    explicit DeformableSimulation(const Problem& problem, Target target = best_target())
        : DeformableSimulation(std::shared_ptr<const Problem>(std::shared_ptr<void>(), &problem), std::move(target)) {}
    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t arm) const override;
    void simulate(std::size_t arm, const Batch& batch) const override;
    void check_repeats(std::uint64_t root_seed) const override;
    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override;
    CountedVariances counted(std::size_t arm, std::uint64_t root_seed, std::int64_t trials) const override;

private:
    std::shared_ptr<const Problem> problem_;
    Target target_;
    std::vector<Arm> arms_;
    SimulationShape shape_;
};

/// Adds the planner's candidates, which are the same at every pose. Returns the place of their costs.
std::size_t add_candidates(Trajectory& trajectory, const DeformableSettings& settings);

/// One trial of a problem.
Trajectory replay_trial(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trial,
                        const Target& target = best_target());

/// Throws InputError where the noise record is too short, too narrow or lacks draws of the scenario. `file` names it.
void check_covers(const NoiseRecord& record, const DeformableSettings& scenario, const std::string& file);

/// A block of a problem's trials, on a target [block.hpp].
Block run_block(const Problem& problem, std::uint64_t root_seed, std::int64_t index, int trials,
                const Target& target = best_target());

}  // namespace credence
