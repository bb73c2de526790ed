// NEES in place of covariances.

#include <algorithm>
#include <cmath>

#include "record/layout/parts.hpp"

namespace credence {

void set_sources(GroupSource source, RecordLayout& layout) {
    layout.shape.sources.assign(layout.shape.groups.size(), source);
    layout.shape.group_epsilons.assign(layout.shape.groups.size(), 0);
    layout.data.own.resize(layout.shape.groups.size());
}

int open_nees(const RecordSource& source, const std::string& path, std::size_t b, RecordLayout& layout) {
    layout.data.own[b] = source.open(path);
    const std::string name = "dimension", place = record_attribute_place(name, path);
    if (!source.has_attribute(name, path))
        throw RecordError(place, "is missing", "Write the number of components of " + record_place(path),
                          "Give dimension, the number of components");
    const double dimension = source.number(name, path).value_or(0);
    if (!(dimension >= 1 && dimension <= static_cast<double>(largest_record_state) &&
          dimension == std::nearbyint(dimension)))
        throw RecordError(place, "is no number of components", "Write a whole number from 1 to 1000");
    return static_cast<int>(dimension);
}

namespace {

/// Names the groups by their datasets, and opens these.
void open_named(const RecordSource& source, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    const std::vector<std::string> names = source.names_in("group");
    if (names.empty() && !source.has("nees"))
        throw RecordError(
            record_place("error"), "is missing",
            "Write `error` [trial, step, n], `truth` and `estimate` with the attribute `manifold`, or a NEES "
            "[trial, step] with the attribute `dimension`, /nees or /group/NAME/nees",
            "Give error [trial, step, n], or truth and estimate with their manifold, or nees [trial, step] "
            "with its dimension");
    shape.groups = {{"all", 0, 0}};
    for (const std::string& name : names) {
        require_group_name(name, record_place("group"));
        shape.groups.push_back({name, 0, 0});
    }
    set_sources(GroupSource::nees, layout);
    if (source.has("nees"))
        shape.groups[0].count = open_nees(source, "nees", 0, layout);
    else
        shape.sources[0] = GroupSource::nothing;
    for (std::size_t b = 1; b < shape.groups.size(); ++b)
        shape.groups[b].count = open_nees(source, "group/" + shape.groups[b].name + "/nees", b, layout);
}

}  // namespace

PlacedExtents open_nees_alone(const RecordSource& source, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    open_named(source, layout);
    if (shape.sources[0] == GroupSource::nothing) {
        int& all = shape.groups[0].count;
        for (std::size_t b = 1; b < shape.groups.size(); ++b)
            all = std::min(all + shape.groups[b].count, static_cast<int>(largest_record_state));
    }
    shape.n = shape.groups[0].count;
    PlacedExtents leading = placed(layout.data.own[0] ? *layout.data.own[0] : *layout.data.own[1]);
    set_extents(leading, 2, "[trial, step]", layout);
    leading.extents.push_back(1);
    for (const DatasetPointer& nees : layout.data.own)
        if (nees) require_same_steps(leading, *nees, leading.extents.size() - 1, "Write it as [trial, step]");
    return leading;
}

}  // namespace credence
