#pragma once
// Module engine: the worlds that there are, as engine, store and program see them. The one who writes a world of his
// own reads own_world.hpp.

#include <credence/detail/batch.hpp>
#include <credence/scenario.hpp>
#include <credence/trajectory.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// Trials of one scenario, ready to run. Thread-safe.
class Simulation {
public:
    virtual ~Simulation() = default;
    virtual const SimulationShape& shape() const = 0;
    /// Bytes that a batch of this arm needs as its workspace.
    virtual std::size_t workspace_size(std::size_t arm) const = 0;
    /// Simulates a batch of trials of the arm at that place in the scenario's list.
    virtual void simulate(std::size_t arm, const Batch& batch) const = 0;
    /// Runs one trial of that arm again, the same bits as in a batch, and records it. `scenario` is that of the
    /// simulation.
    virtual Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                              std::int64_t trial) const = 0;
};

/// A scenario while its settings are read.
class Draft {
public:
    virtual ~Draft() = default;
    /// Throws InputError for an unknown key, or a value out of its range. `value` has no outer blanks.
    virtual void set(const std::string& key, const std::string& value) = 0;
    /// The resolved scenario. Throws InputError where keys contradict each other.
    virtual Scenario declare() const = 0;
};

/// A key as `credence show` prints it.
struct DescribedKey {
    std::string key, value, help;         ///< its default, and what it means
    std::vector<std::string> choices{};   ///< to offer; empty: any in range
};

/// A kind of world.
class World {
public:
    virtual ~World() = default;
    virtual std::string name() const = 0;
    virtual std::vector<DescribedKey> keys() const = 0;
    virtual std::unique_ptr<Draft> draft() const = 0;
    /// What the trials and steps of a scenario report; the same for every arm.
    virtual std::vector<Column> columns(const Scenario& scenario) const = 0;
    virtual std::vector<Series> all_series(const Scenario& scenario) const = 0;
    virtual std::unique_ptr<const Simulation> simulation(const Scenario& scenario) const = 0;
};

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
