#include <credence/detail/store.hpp>

#include "files/results/format.hpp"

#include <map>

namespace credence {

namespace {

using hdf5::Dimension;
using hdf5::Handle;

/// Writes the trial's columns, and the source of its noise, as attributes of the group.
void write_columns(const Handle& group, const Trajectory& trajectory) {
    hdf5::write_text(group, "source", trajectory.source);
    for (std::size_t c = 0; c < trajectory.columns.size(); ++c) {
        const std::string& name = trajectory.columns[c].name;
        const double value = trajectory.column_values[c];
        const ColumnType type = trajectory.columns[c].type;
        as_stored(type, [&]<class T>(T) { hdf5::write_number(group, name, static_cast<T>(one_nan(value))); });
        if (type == ColumnType::status)
            hdf5::write_text(group, name + "_text", status_names().at(static_cast<std::size_t>(value)));
    }
}

std::map<std::string, Dimension> write_dimensions(const Handle& group, const Trajectory& trajectory) {
    std::map<std::string, Dimension> dimensions;
    for (const TrajectoryDimension& one : trajectory.dimensions)
        dimensions.emplace(one.name, numbered<std::int32_t>(group, one.name, 0, one.size, one.long_name));
    const std::vector<Component>& components = trajectory.scenario.components;
    dimensions.emplace("component", new_component_dimension(group, components, "component", "component of the state"));
    dimensions.emplace("component_2", new_component_dimension(group, components, "component_2",
                                                              "component of the state, along columns"));
    return dimensions;
}

template <class T>
Handle write_as(const Handle& group, const TrajectoryVariable& variable, const hdf5::Dimensions& along) {
    std::vector<T> values;
    for (const double value : variable.values) values.push_back(static_cast<T>(one_nan(value)));
    return hdf5::new_variable(group, variable.name, values, along, {variable.long_name, variable.unit});
}

/// Where a value may not exist, the file says what stands for it.
void write_variable(const Handle& group, const TrajectoryVariable& variable, const hdf5::Dimensions& along) {
    const auto write = [&]<class T>(T fill) {
        Handle written = write_as<T>(group, variable, along);
        if (variable.dimensions.front() == "pose" && variable.numbers != TrajectoryNumbers::flag)
            hdf5::write_numbers<T>(written, "_FillValue", {fill});
        return written;
    };
    if (variable.numbers == TrajectoryNumbers::real) return void(write(one_nan(nan)));
    if (variable.numbers == TrajectoryNumbers::integer) return void(write(std::int32_t{-1}));
    const Handle written = write(std::int8_t{-1});
    std::vector<std::int8_t> codes{-1};
    for (const char c : variable.flags)
        if (c == ' ') codes.push_back(static_cast<std::int8_t>(codes.back() + 1));
    hdf5::write_numbers<std::int8_t>(written, "flag_values", codes);
    hdf5::write_text(written, "flag_meanings", variable.flags);
}

void write_trajectory(const Handle& scenario_group, const Trajectory& trajectory) {
    const Handle group = hdf5::new_group(scenario_group, trajectory.arm);
    write_columns(group, trajectory);
    std::map<std::string, Dimension> dimensions = write_dimensions(group, trajectory);
    for (const TrajectoryVariable& variable : trajectory.variables) {
        hdf5::Dimensions along;
        for (const std::string& name : variable.dimensions) along.push_back(&dimensions.at(name));
        write_variable(group, variable, along);
    }
    for (auto& [name, dimension] : dimensions) dimension.close();
    for (const auto& [name, text] : trajectory.notes) hdf5::write_text(group, name, text);
}

}  // namespace

void write_trajectories(const Output& output, const std::vector<Trajectory>& trajectories, const RunFacts& run) {
    for (const Trajectory& trajectory : trajectories) refuse_reserved_name(trajectory.scenario);
    write_file(output, [&](const Handle& root) {
        write_header(root, trajectories_format, "Single trials with everything that happened in them");
        std::map<std::string, Handle> groups;
        for (const Trajectory& trajectory : trajectories) {
            const std::string& name = trajectory.scenario.name;
            if (groups.count(name) == 0) groups.emplace(name, new_scenario_group(root, trajectory.scenario));
            write_trajectory(groups.at(name), trajectory);
        }
        write_run_facts(root, run);
    });
}

}  // namespace credence
