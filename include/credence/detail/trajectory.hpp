#pragma once
// Module engine: the trajectory of a single trial of any world: what `credence replay` prints and writes.

#include <credence/detail/scenario.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// A dimension of variables: its coordinate counts from 0.
struct TrajectoryDimension {
    std::string name, long_name;
    std::size_t size = 0;
};

/// The type of a variable's numbers in a file, and the value of those that do not exist: NaN, -1, -1.
enum class TrajectoryNumbers { real, integer, flag };

/// A quantity of the trial, such as the estimated state at each pose.
struct TrajectoryVariable {
    std::string name, long_name, unit;
    std::vector<std::string> dimensions;  ///< names; the first is `pose` where the quantity has a value at each pose
    TrajectoryNumbers numbers = TrajectoryNumbers::real;
    std::string flags{};                  ///< of flags: what -1, 0, 1 ... mean, separated by blanks
    std::vector<double> values{};         ///< row-major
};

/// One trial under one arm.
struct Trajectory {
    Scenario scenario;                            ///< resolved
    std::string arm;
    std::string source;                           ///< of its noise: `root seed 1, trial 17`, `noise record`
    std::vector<Column> columns;
    std::vector<double> column_values;            ///< [columns] as in the results file
    std::vector<TrajectoryDimension> dimensions;  ///< beside the components of the state: `component` and `component_2`
    std::vector<TrajectoryVariable> variables;
    std::vector<std::pair<std::string, std::string>> notes;  ///< name and text, such as why a variable is left out

    /// Number of values of a variable: those of all poses, where it has that dimension.
    std::size_t value_count(const TrajectoryVariable& variable) const;
    /// Adds a variable, its values those of numbers that do not exist, and returns its place.
    std::size_t add(TrajectoryVariable variable);
    /// The values of that variable at a pose.
    double* at(std::size_t variable, int pose);
};

/// An empty trajectory with the dimension `pose`.
Trajectory empty_trajectory(const Scenario& scenario, const std::string& arm, const std::vector<Column>& columns);

/// `root seed 1, trial 17`
std::string source_text(std::uint64_t root_seed, std::int64_t trial);

/// Matrices of a single trial are recorded up to this many rows; larger ones would take gigabytes.
inline constexpr std::size_t largest_recorded_matrix = 512;

}  // namespace credence
