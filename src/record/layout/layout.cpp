// Which datasets a record has.

#include "record/layout/layout.hpp"

#include <credence/text.hpp>

#include "record/layout/parts.hpp"

#include <algorithm>
#include <limits>

namespace credence {

std::vector<const RecordDataset*> RecordDatasets::leading() const {
    if (error) return {error.get()};
    if (estimate) return {estimate.get()};
    std::vector<const RecordDataset*> all;
    for (const DatasetPointer& nees : own)
        if (nees) all.push_back(nees.get());
    return all;
}

void set_extents(const PlacedExtents& leading, std::size_t rank, const std::string& written, RecordLayout& layout) {
    const RecordExtents& extents = leading.extents;
    if (extents.size() != rank && extents.size() + 1 != rank)
        throw RecordError(leading.place, "is " + extents_text(extents), "Write it as " + written);
    layout.single = extents.size() + 1 == rank;
    const std::size_t step = layout.single ? 0 : 1;
    if (!layout.single) require_between(leading, 0, std::numeric_limits<std::uint64_t>::max(), "trials");
    require_between(leading, step, largest_record_steps, "steps");
    layout.shape.trials = layout.single ? 1 : static_cast<std::int64_t>(extents[0]);
    layout.shape.steps = static_cast<int>(extents[step]);
}

void set_state(const PlacedExtents& error, RecordLayout& layout) {
    set_extents(error, 3, "[trial, step, n]", layout);
    require_between(error, error.extents.size() - 1, largest_record_state, "components");
    layout.shape.n = static_cast<int>(error.extents.back());
}

namespace {

/// Throws unless the root attribute `record_version` is 2, or missing.
void check_version(const RecordSource& source) {
    const std::string name = "record_version", place = record_attribute_place(name);
    if (!source.has_attribute(name)) return;
    const std::optional<double> version = source.number(name);
    if (!version) throw RecordError(place, "is not one number", "Write 2");
    if (*version != 2)
        throw RecordError(place, "is " + to_text(*version),
                          "Write 2, or use a newer credence if there is such a version");
}

void open_innovations(const RecordSource& source, RecordDatasets& data) {
    data.innovation = open_optional(source, "innovation", "innovation_covariance");
    data.innovation_covariance = open_optional(source, "innovation_covariance", "innovation");
}

void add_innovations(const RecordSource& source, const PlacedExtents& leading, RecordLayout& layout) {
    const RecordDatasets& data = layout.data;
    if (!data.innovation) return;
    const PlacedExtents innovation = placed(*data.innovation);
    require_squares(innovation, *data.innovation_covariance, "innovation", "innovation_covariance");
    require_same_steps(leading, *data.innovation, leading.extents.size(),
                       "Write it as [trial, step, row], with NaN where a step has no such row");
    require_between(innovation, leading.extents.size() - 1, largest_record_rows, "rows");
    RecordShape& shape = layout.shape;
    shape.m = static_cast<int>(innovation.extents.back());
    shape.innovation_epsilon = data.innovation_covariance->epsilon();
    const std::string name = "row_groups";
    if (source.has_attribute(name))
        shape.row_groups = parse_row_groups(source.list(name), shape.m, record_attribute_place(name));
}

RecordLayout open_datasets(const RecordSource& source) {
    RecordLayout layout;
    open_innovations(source, layout.data);
    PlacedExtents leading = open_errors(source, layout.data);
    layout.shape.has_errors = !leading.extents.empty();
    if (layout.shape.has_errors)
        open_states(source, leading, layout);
    else
        leading = open_nees_alone(source, layout);
    add_innovations(source, leading, layout);
    add_steps(source, layout.shape);
    check_time(source, layout);
    return layout;
}

/// The series of a trial are in memory [RecordTotals]: a small file could ask for more than there is.
void require_room(const RecordShape& shape) {
    constexpr std::int64_t most = std::int64_t{1} << 28;
    constexpr int least_steps = 3000;  // for whose series the totals of many groups have no room
    if (std::ssize(record_series(shape).list) * std::max(shape.steps, least_steps) > most)
        throw RecordError("/",
                          "has " + std::to_string(shape.groups.size()) + " component groups and " +
                              std::to_string(shape.n) + " components at " + std::to_string(shape.steps) +
                              " steps, together more than " + std::to_string(most) + " numbers of each trial",
                          "Write fewer groups, or every tenth step");
}

}  // namespace

RecordLayout open_record(const RecordSource& source) {
    check_version(source);
    const bool of_innovations = has_innovations_alone(source);
    RecordLayout layout = open_datasets(of_innovations ? *innovations_of(source) : source);
    layout.shape.of_innovations = of_innovations;
    add_truth_covariance(source, layout);
    add_columns(source, layout.shape);
    require_room(layout.shape);
    return layout;
}

}  // namespace credence
