#pragma once
// Definitions shared by the two kinds of file that the store writes. docs/results-format.md describes the files.

#include <credence/error.hpp>
#include <credence/detail/store.hpp>
#include <credence/text.hpp>

#include "base/nan.hpp"
#include "files/hdf5/write.hpp"
#include "files/system/byte_file.hpp"
#include "files/system/durable_file.hpp"

#include <algorithm>

namespace credence {

inline const std::string results_format = "credence results", trajectories_format = "credence trajectories";
inline const std::string run_group = "run";
/// Facts in the group /run: the releases that computed trials, and the one that wrote the file.
inline const std::string computed_by_fact = "computed_by", version_fact = "credence_version",
                         revision_fact = "git_revision";

/// Calls use(T()) with the type T in which files hold the values of a column.
template <class Use>
auto as_stored(ColumnType type, const Use& use) {
    switch (type) {
        case ColumnType::real: return use(double());
        case ColumnType::integer: return use(std::int32_t());
        case ColumnType::status: break;
    }
    return use(std::int8_t());
}

/// The bits of NaN depend on the processor; files hold one fixed NaN.
inline double one_nan(double value) { return value == value ? value : nan; }

/// Refuses the name of the group /run for a scenario.
inline void refuse_reserved_name(const Scenario& scenario) {
    if (scenario.name == run_group)
        throw invalid_value("scenario.name", scenario.name, "the file keeps that group for facts of the machine",
                            "Give another name");
}

inline void write_header(const hdf5::Handle& root, const std::string& format, const std::string& title) {
    hdf5::write_text(root, "format", format);
    hdf5::write_number<std::int32_t>(root, "schema_version", schema_version);
    hdf5::write_text(root, "title", title);
}

/// `0:3`, or `0 2 5` where they are not contiguous.
inline std::string components_text(const ComponentGroup& group) {
    if (group.contiguous()) return std::to_string(group.first) + ":" + std::to_string(group.first + group.count);
    std::string text;
    for (const int component : group.components) text += (text.empty() ? "" : " ") + std::to_string(component);
    return text;
}

/// The component groups of a state as the attribute `groups` has them: `pose 0:3, heading 0:1`, without the whole
/// state.
inline std::string groups_text(const std::vector<ComponentGroup>& groups) {
    std::vector<std::string> texts;
    for (const ComponentGroup& group : groups)
        if (group.name != "all") texts.push_back(group.name + " " + components_text(group));
    return joined(texts);
}

/// A scenario's place in a sweep as attributes of its group, for readers that do not parse the scenario's text:
/// `sweep_of`, `sweep_keys` and `sweep.KEY` for every key, as a number where the value is one, else as text; none where
/// the scenario is not a point of a sweep.
void write_sweep(const hdf5::Handle& group, const SweepPoint& point);
/// Throws hdf5::Error unless the group has exactly these attributes.
void check_sweep(const hdf5::Handle& group, const SweepPoint& point);

inline hdf5::Handle new_scenario_group(const hdf5::Handle& root, const Scenario& scenario) {
    hdf5::Handle group = hdf5::new_group(root, scenario.name);
    hdf5::write_text(group, "title", scenario.title);
    hdf5::write_text(group, "length_unit", scenario.length_unit);
    hdf5::write_text(group, "scenario", scenario_text(scenario));
    hdf5::write_text(group, "groups", groups_text(scenario.groups));
    write_sweep(group, scenario.sweep);
    return group;
}

inline void write_run_facts(const hdf5::Handle& root, const RunFacts& run) {
    const hdf5::Handle group = hdf5::new_group(root, run_group);
    for (const auto& [name, text] : run) hdf5::write_text(group, name, text);
}

/// The pose, trial, step or feature numbers of a dimension: first, first + 1 ...
template <class T>
hdf5::Dimension numbered(const hdf5::Handle& group, const std::string& name, T first, std::size_t count,
                         const std::string& long_name) {
    std::vector<T> values(count);
    for (T& value : values) value = first++;
    return hdf5::new_dimension(group, name, values, {long_name, "1"});
}

/// The meanings of the codes of a status variable.
inline void write_status_flags(const hdf5::Handle& variable) {
    std::vector<std::int8_t> codes;
    for (std::size_t code = 0; code < status_names().size(); ++code) codes.push_back(static_cast<std::int8_t>(code));
    hdf5::write_numbers(variable, "flag_values", codes);
    hdf5::write_text(variable, "flag_meanings", joined(status_names(), " "));
}

/// The attribute `units` of a state, whose components differ in units if one is a heading.
inline std::string state_units(const std::vector<Component>& components) {
    const std::string& first = components.front().unit;
    return std::ranges::count(components, first, &Component::unit) == std::ssize(components) ? first
                                                                                             : "see component_units";
}

/// A dimension along the components of the state, with their names and units.
inline hdf5::Dimension new_component_dimension(const hdf5::Handle& group, const std::vector<Component>& components,
                                               const std::string& name, const std::string& long_name) {
    std::vector<std::string> names, units;
    for (const Component& component : components) {
        names.push_back(component.name);
        std::replace(names.back().begin(), names.back().end(), ' ', '_');  // what parts the names
        units.push_back(component.unit);
    }
    hdf5::Dimension dimension = numbered<std::int32_t>(group, name, 0, names.size(), long_name);
    hdf5::write_text(dimension.scale, "component_names", joined(names, " "));
    hdf5::write_text(dimension.scale, "component_units", joined(units, " "));
    return dimension;
}

/// Writes an HDF5 file aside and renames it to its name. HDF5 itself only fails for want of memory.
template <class Build>
void write_file(const Output& output, Build build) {
    write_durably(output, [&](int descriptor) {
        ByteFile bytes(descriptor);
        try {
            const hdf5::QuietErrors quiet;
            hdf5::Handle root = hdf5::new_file(bytes);
            build(root);
            root.close();
        } catch (const hdf5::Error& error) {
            if (bytes.error() == 0)
                throw Failure("cannot write " + output.path,
                              error.complaint().place + ": " + error.complaint().subject, "Free some memory");
        }
        return bytes.error();
    });
}

}  // namespace credence
