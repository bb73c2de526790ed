#pragma once
// Module engine: a world, as engine, store and program see it. The one who writes a world of his own reads
// own_world.hpp.

#include <credence/detail/batch.hpp>
#include <credence/detail/scenario.hpp>
#include <credence/detail/trajectory.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace credence {

/// The variances of the state as sums over sources: P propagated for each alone, with the filter's own gains, by
/// Joseph's form [docs/budget.md].
struct CountedVariances {
    std::vector<std::string> sources;
    std::vector<std::vector<double>> variance;  ///< [sources][n]
    std::int64_t trials = 0;                    ///< over which they are means
};

/// Trials of one scenario, ready to run. Thread-safe.
class Simulation {
public:
    virtual ~Simulation() = default;
    virtual const SimulationShape& shape() const = 0;
    /// Bytes that a batch of this arm needs as its workspace.
    virtual std::size_t workspace_size(std::size_t arm) const = 0;
    /// Simulates a batch of trials of the arm at that place in the scenario's list.
    virtual void simulate(std::size_t arm, const Batch& batch) const = 0;
    /// Throws InputError where trial 0 of an arm gives other numbers when it runs again; of worlds of users.
    virtual void check_repeats(std::uint64_t) const {}
    /// Runs one trial of that arm again, the same bits as in a batch, and records it. `scenario` is that of the
    /// simulation.
    virtual Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                              std::int64_t trial) const = 0;
    /// What P of that arm counts for each source, mean over the first trials and the steps that the scenario keeps the
    /// errors of; empty where the world does not know. Throws Failure where the parts do not add up to P.
    virtual CountedVariances counted(std::size_t, std::uint64_t, std::int64_t) const { return {}; }
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
    std::string sigma_unit{};             ///< as of KeyOf
};

/// A source of a world's draws by its name, and its bits [draws.hpp, source_bit].
struct DrawSource {
    std::string name;
    std::uint32_t bits = 0;
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
    /// The sources that its trials draw from; none of a world that does not name them.
    virtual std::vector<DrawSource> sources(const Scenario& scenario) const = 0;
    virtual std::unique_ptr<const Simulation> simulation(const Scenario& scenario) const = 0;
};

}  // namespace credence
