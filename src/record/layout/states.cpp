// The datasets of a record that has errors.

#include <algorithm>

#include "record/layout/parts.hpp"

namespace credence {

namespace {

void require_coordinates(const RecordDataset& dataset, const RecordExtents& extents, std::uint64_t coordinates) {
    if (dataset.extents() == extents && !extents.empty() && extents.back() == coordinates) return;
    throw RecordError(dataset.place(),
                      "does not fit: it is " + extents_text(dataset.extents()) + ", and the manifold has " +
                          std::to_string(coordinates) + " coordinates",
                      "Write truth and estimate as [trial, step, " + std::to_string(coordinates) + "]");
}

/// `covariance` [..., n, n], or [..., n] variances.
void open_covariance(const RecordSource& source, const PlacedExtents& error, RecordLayout& layout) {
    if (!source.has("covariance")) return;
    layout.data.covariance = source.open("covariance");
    const RecordDataset& covariance = *layout.data.covariance;
    layout.shape.covariance_epsilon = covariance.epsilon();
    layout.shape.has_variances = covariance.extents() == error.extents;
    if (!layout.shape.has_variances) require_squares(error, covariance, "error", "covariance");
}

/// The index of a group by its name; the number of groups where there is none of that name.
std::size_t find_group(const RecordShape& shape, const std::string& name) {
    const auto found = std::ranges::find(shape.groups, name, &ComponentGroup::name);
    return static_cast<std::size_t>(found - shape.groups.begin());
}

/// Those of the manifold, unless a group of other components has such a name.
std::vector<Component> default_components(const RecordLayout& layout) {
    if (!layout.data.manifold) return {};
    const std::vector<Component> components = layout.data.manifold->components();
    for (const ComponentGroup& group : layout.shape.groups)
        for (int j = 0; j < static_cast<int>(components.size()); ++j)
            if (components[static_cast<std::size_t>(j)].name == group.name &&
                (group.count > 1 || group.component(0) != j))
                return {};
    return components;
}

/// Angles of a manifold have one unit.
void require_radians(const RecordSource& source, const RecordLayout& layout) {
    const std::string attribute = "component_units";
    if (!layout.data.manifold || !source.has_attribute(attribute)) return;
    const std::vector<Component> components = layout.data.manifold->components();
    for (std::size_t j = 0; j < components.size(); ++j)
        if (const std::string& unit = layout.shape.components[j].unit; components[j].unit == "rad" && unit != "rad")
            throw RecordError(record_attribute_place(attribute),
                              "has `" + unit + "` for " + components[j].name + ", an angle of the manifold",
                              "Give it in rad");
}

/// Of variances each component is judged by itself, whether the record names it as a group or not.
void add_single_groups(RecordShape& shape) {
    std::vector<char> alone(static_cast<std::size_t>(shape.n), 0);
    for (const ComponentGroup& group : shape.groups)
        if (group.count == 1) alone[static_cast<std::size_t>(group.component(0))] = 1;
    for (int j = 0; j < shape.n; ++j) {
        if (shape.n == 1 || alone[static_cast<std::size_t>(j)]) continue;
        const std::string name = component_name(shape, j);
        if (find_group(shape, name) < shape.groups.size())
            throw RecordError(record_attribute_place("groups"), "`" + name + "` is a component's name as well",
                              "Use another name for the group");
        shape.groups.push_back({name, j, 1});
    }
}

/// A NEES [...] beside errors, of the whole state (b = 0) or of a group.
void open_nees_beside(const RecordSource& source, const std::string& path, const PlacedExtents& error, std::size_t b,
                      RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    const int dimension = open_nees(source, path, b, layout), count = shape.groups[b].count;
    require_same_steps(error, *layout.data.own[b], error.extents.size() - 1, "Write it as [trial, step]");
    if (dimension != count)
        throw RecordError(record_place(path),
                          std::string("has another dimension than ") + (b == 0 ? "the error" : "its group"),
                          "Write " + std::to_string(count));
    shape.sources[b] = GroupSource::nees;
}

/// A group's own covariance [..., d, d].
void open_group_covariance(const RecordSource& source, PlacedExtents error, std::size_t b, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    layout.data.own[b] = source.open("group/" + shape.groups[b].name + "/covariance");
    shape.sources[b] = GroupSource::own;
    shape.group_epsilons[b] = layout.data.own[b]->epsilon();
    error.extents.back() = static_cast<std::uint64_t>(shape.groups[b].count);
    require_squares(error, *layout.data.own[b], "error", "covariance");
}

/// The datasets of /group/NAME: `covariance` or `nees`.
void open_group(const RecordSource& source, const PlacedExtents& error, const std::string& name, RecordLayout& layout) {
    const std::string path = "group/" + name, place = record_place(path);
    const std::size_t b = find_group(layout.shape, name);
    if (b == 0 || b == layout.shape.groups.size())
        throw RecordError(place, "is no group of components", "Name its components in the root's attribute `groups`",
                          "Name its components in groups");
    const bool covariance = source.has(path + "/covariance"), nees = source.has(path + "/nees");
    if (covariance == nees)
        throw RecordError(place, covariance ? "has a covariance and a NEES" : "has neither `covariance` nor `nees`",
                          "Write one of them");
    if (nees)
        open_nees_beside(source, path + "/nees", error, b, layout);
    else
        open_group_covariance(source, error, b, layout);
}

void require_something(const RecordShape& shape) {
    for (std::size_t b = 1; b < shape.groups.size(); ++b)
        if (shape.sources[b] == GroupSource::nothing)
            throw RecordError(record_attribute_place("groups"), "nothing to judge `" + shape.groups[b].name + "` by",
                              "Write /covariance, or /group/" + shape.groups[b].name + "/covariance or nees",
                              "Give covariance, or the group's own in group_covariance or group_nees");
    if (shape.groups.size() == 1 && shape.sources[0] == GroupSource::nothing)
        throw RecordError(
            record_place("covariance"), "is missing",
            "Write it as [trial, step, n, n], or as [trial, step, n] where there are variances only, or write "
            "covariances of groups, /group/NAME/covariance",
            "Give it as [trial, step, n, n], or as [trial, step, n] if there are variances only, or give "
            "group_covariance, the covariances of groups by their names");
}

}  // namespace

PlacedExtents open_errors(const RecordSource& source, RecordDatasets& data) {
    if (source.has("error")) {
        if (source.has("estimate"))
            throw RecordError(record_place("estimate"), "is there, and `error` too",
                              "Write `error`, or `truth` and `estimate`");
        data.error = source.open("error");
        return placed(*data.error);
    }
    data.truth = open_optional(source, "truth", "estimate");
    data.estimate = open_optional(source, "estimate", "truth");
    if (!data.estimate) return {};
    data.manifold = Manifold::read(source);
    PlacedExtents error = placed(*data.estimate);
    for (const RecordDataset* dataset : {data.estimate.get(), data.truth.get()})
        require_coordinates(*dataset, error.extents, static_cast<std::uint64_t>(data.manifold->coordinates()));
    error.extents.back() = static_cast<std::uint64_t>(data.manifold->dimension());
    return error;
}

void open_states(const RecordSource& source, const PlacedExtents& error, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    set_state(error, layout);
    shape.groups = read_groups(source, shape.n);
    shape.components = read_components(source, shape.n, default_components(layout));
    require_radians(source, layout);
    open_covariance(source, error, layout);
    if (shape.has_variances) add_single_groups(shape);
    set_sources(!layout.data.covariance ? GroupSource::nothing
                : shape.has_variances   ? GroupSource::variances
                                        : GroupSource::joint,
                layout);
    if (source.has("nees")) {
        if (shape.has_joint())
            throw RecordError(record_place("nees"), "is there, and a joint covariance too", "Write one of them");
        open_nees_beside(source, "nees", error, 0, layout);
    }
    for (const std::string& name : source.names_in("group")) open_group(source, error, name, layout);
    require_something(shape);
}

}  // namespace credence
