#pragma once
// Module worlds: the worlds that there are.

#include <credence/detail/world.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// The arm that each of these is compared with: `fixed.X`; beside a planner without it, another controller that does
/// not plan; beside `horizon.X` first of all the greedy one. Empty where there is none.
std::vector<std::string> baselines_among(const std::vector<std::string>& arms);

/// Adds a world to those that there are. Not thread-safe: before anything else.
void add_world(std::unique_ptr<const World> world);

/// All of them, the deformable one first.
std::vector<const World*> all_worlds();

/// The world of this name; nullptr where there is none.
const World* find_world(const std::string& name);

/// The same; throws InputError where there is none, so that the program that has it must be used, or where there are
/// two.
const World& world_of(const Scenario& scenario);

/// The scenario made ready by its world. Throws like world_of.
std::unique_ptr<const Simulation> simulation_of(const Scenario& scenario);

/// Runs one trial of an arm of the scenario again. Throws like world_of.
Trajectory replay_trial(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed, std::int64_t trial);

struct NoiseRecord;
/// Runs every arm of the scenario on recorded noise, `file` its name. Throws InputError where the scenario is of a
/// world that knows no such noise, or the record does not cover it.
std::vector<Trajectory> replay_record(const Scenario& scenario, const NoiseRecord& record, const std::string& file);

}  // namespace credence
