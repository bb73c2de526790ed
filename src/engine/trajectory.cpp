#include <credence/detail/trajectory.hpp>

#include "base/nan.hpp"

#include <stdexcept>

namespace credence {

namespace {

std::size_t extent(const Trajectory& trajectory, const std::string& dimension) {
    if (dimension == "component" || dimension == "component_2") return trajectory.scenario.components.size();
    for (const TrajectoryDimension& one : trajectory.dimensions)
        if (one.name == dimension) return one.size;
    throw std::logic_error("a trajectory has no dimension " + dimension + ".");
}

}  // namespace

std::size_t Trajectory::value_count(const TrajectoryVariable& variable) const {
    std::size_t count = 1;
    for (const std::string& dimension : variable.dimensions) count *= extent(*this, dimension);
    return count;
}

std::size_t Trajectory::add(TrajectoryVariable variable) {
    variable.values.assign(value_count(variable), variable.numbers == TrajectoryNumbers::real ? nan : -1);
    variables.push_back(std::move(variable));
    return variables.size() - 1;
}

double* Trajectory::at(std::size_t variable, int pose) {
    std::vector<double>& values = variables[variable].values;
    return values.data() + values.size() / static_cast<std::size_t>(scenario.poses) * static_cast<std::size_t>(pose);
}

Trajectory empty_trajectory(const Scenario& scenario, const std::string& arm, const std::vector<Column>& columns) {
    Trajectory trajectory{scenario, arm, {}, columns, std::vector<double>(columns.size()), {}, {}, {}};
    trajectory.dimensions.push_back({"pose", "pose", static_cast<std::size_t>(scenario.poses)});
    return trajectory;
}

std::string source_text(std::uint64_t root_seed, std::int64_t trial) {
    return "root seed " + std::to_string(root_seed) + ", trial " + std::to_string(trial);
}

}  // namespace credence
