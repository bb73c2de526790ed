#pragma once
// The contents of results files as docs/results-format.md documents them in its tables, and of a file, in the same
// words: `arm attribute counted_trials: int64`, `variable F_total [step, part]: double`, `series nees_pose: nees`.

#include <credence/text.hpp>

#include "files/hdf5/read.hpp"
#include "files/results/parts.hpp"

#include <hdf5_hl.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace credence::test {

using Facts = std::set<std::string>;

/// The matches' first group, of a pattern in a text.
inline std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
    std::vector<std::string> found;
    const std::regex expression(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) found.push_back((*i)[1]);
    return found;
}

/// The dimensions that the i-th name of a row has: in brackets after it or in the header, or in a column of its own.
inline std::string documented_shape(const std::vector<std::string>& header, const std::vector<std::string>& cells,
                                    const std::string& name, std::size_t i) {
    if (header[0] == "dimension") return name;
    if (header[1] == "shape") {
        const std::vector<std::string> shapes = split_list(cells[1], ';');
        return shapes[std::min(i, shapes.size() - 1)];
    }
    for (const std::string& cell : {cells[0], header[0]})
        if (const auto shape = matches(cell, R"(\[([a-z_, ]+)\])"); !shape.empty()) return shape[0];
    return {};
}

/// The entries of a row of a table.
inline void add_row(const std::vector<std::string>& header, const std::vector<std::string>& cells, Facts& facts) {
    const std::vector<std::string> names = matches(cells[0], R"(`([A-Za-z_][\w.]*)`)");
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (header[0] == "series F") {
            facts.insert("series " + names[i] + ": " + cells[1]);
            continue;
        }
        const std::vector<std::string> types = split_list(cells[header[1] == "shape" ? 2 : 1]);
        const std::string type = types[std::min(i, types.size() - 1)];
        const std::string shape = documented_shape(header, cells, names[i], i);
        facts.insert(shape.empty() ? header[0] + " " + names[i] + ": " + type
                                   : "variable " + names[i] + " [" + shape + "]: " + type);
    }
}

/// The entries of all tables of a section of the page.
inline Facts documented(const std::string& part) {
    Facts facts;
    std::vector<std::string> header;
    std::istringstream lines(part);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("|")) {
            header.clear();
            continue;
        }
        const std::vector<std::string> cells = split_list(line.substr(1), '|');
        if (header.empty()) header = cells;
        else if (!cells[0].starts_with("---")) add_row(header, cells, facts);
    }
    return facts;
}

inline std::string type_name(hid_t type, const std::string& place) {
    if (H5Tget_class(type) == H5T_STRING) return "text";
    const std::vector<std::pair<hid_t, std::string>> known{
        {hdf5::type_of<std::int8_t>().file, "int8"},     {hdf5::type_of<std::int32_t>().file, "int32"},
        {hdf5::type_of<std::int64_t>().file, "int64"},   {hdf5::type_of<std::uint64_t>().file, "uint64"},
        {hdf5::type_of<float>().file, "float"},          {hdf5::type_of<double>().file, "double"}};
    for (const auto& [candidate, name] : known)
        if (H5Tequal(type, candidate) > 0) return name;
    throw std::runtime_error(place + " has a type that is not documented");
}

/// The series of a group or component are documented once for all of them.
inline std::string general(const std::string& series) {
    for (const char* role : {"nees", "squared_error", "variance"})
        if (series.starts_with(role + std::string("_feature_"))) return role + std::string("_feature_J");
    return series.starts_with("standardised_error_") ? "standardised_error_COMPONENT" : series;
}

/// Names of the dimensions of a dataset, which is a dimension itself or has all its scales attached.
inline std::string dimension_names(const hdf5::Handle& dataset, const std::string& name) {
    if (H5DSis_scale(dataset.id()) > 0) return name;
    const hdf5::Handle space(H5Dget_space(dataset.id()), H5Sclose, name, "");
    std::vector<std::string> names;
    const auto note = [](hid_t, unsigned, hid_t scale, void* to) -> herr_t {
        char text[64] = {};
        H5DSget_scale_name(scale, text, sizeof text);
        static_cast<std::vector<std::string>*>(to)->push_back(text);
        return 1;
    };
    for (int axis = 0; axis < H5Sget_simple_extent_ndims(space.id()); ++axis)
        H5DSiterate_scales(dataset.id(), static_cast<unsigned>(axis), nullptr, note, &names);
    return joined(names, ", ");
}

/// The entries for the attributes of an object in a file.
inline void add_attributes(const hdf5::Handle& object, const std::string& kind, const std::string& own_type,
                           Facts& facts) {
    static const std::set<std::string> of_hdf5{"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST"};
    static const std::set<std::string> of_series{"series", "role", "part_of", "dimension", "rows", "more_rows"};
    for (const std::string& name : hdf5::attribute_names(object)) {
        if (of_hdf5.count(name) > 0) continue;
        const hdf5::Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose, name, "");
        const hdf5::Handle type(H5Aget_type(attribute.id()), H5Tclose, name, "");
        const std::string found = type_name(type.id(), name);
        const std::string said = name.starts_with("sweep.") ? "sweep.KEY" : name;
        const bool fill = name == "_FillValue" && found == own_type;
        facts.insert((of_series.count(name) > 0 ? "series attribute " : kind + " attribute ") + said + ": " +
                     (fill ? "as the variable" : found));
    }
}

/// The entry for a variable in a file.
inline void add_variable(const hdf5::Handle& dataset, const std::string& name, Facts& facts) {
    const hdf5::Handle type(H5Dget_type(dataset.id()), H5Tclose, name, "");
    std::string general_name = name;
    if (H5Aexists(dataset.id(), "series") > 0) {
        const std::string series = hdf5::read_text(dataset, "series");
        general_name = "F" + name.substr(series.size());
        facts.insert("series " + general(series) + ": " + hdf5::read_text(dataset, "role"));
    } else if (name.ends_with("_covered")) {
        general_name = "F_covered";
    }
    const std::string found = type_name(type.id(), name);
    facts.insert("variable " + general_name + " [" + dimension_names(dataset, name) + "]: " + found);
    for (const char* needed : {"long_name", "units"})
        if (hdf5::read_text(dataset, needed).empty()) facts.insert("variable " + name + " has no " + needed);
    add_attributes(dataset, "variable", found, facts);
}

/// The entries for an arm's group, or for that of its trials that did not diverge.
inline void add_arm(const hdf5::Handle& group, Facts& facts) {
    add_attributes(group, "arm", "", facts);
    for (const std::string& name : hdf5::link_names(group))
        if (name != without_diverged)
            add_variable({H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose, name, ""}, name, facts);
}

/// The entries for a whole file, without /run.
inline Facts found_in(const std::string& path) {
    Facts facts;
    const hdf5::Handle root = hdf5::open_file(path);
    add_attributes(root, "root", "", facts);
    for (const std::string& scenario : hdf5::link_names(root)) {
        if (scenario == "run") continue;
        const hdf5::Handle scenario_group = hdf5::open_group(root, scenario);
        add_attributes(scenario_group, "scenario", "", facts);
        for (const std::string& arm : hdf5::link_names(scenario_group)) {
            const hdf5::Handle group = hdf5::open_group(scenario_group, arm);
            add_arm(group, facts);
            if (hdf5::has_link(group, without_diverged)) add_arm(hdf5::open_group(group, without_diverged), facts);
        }
    }
    return facts;
}

}  // namespace credence::test
