#include "files/record/layout.hpp"

#include <credence/text.hpp>

#include "base/nan.hpp"
#include "files/record/extents.hpp"
#include "files/record/groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace credence {

namespace {

using hdf5::Error;
using hdf5::Extents;
using hdf5::extents_text;
using hdf5::Handle;
using hdf5::RealDataset;

/// The number in an attribute, of any type; nothing where it holds anything else.
std::optional<double> read_any_number(const Handle& object, const std::string& name) {
    const std::string place = hdf5::attribute_place(object, name);
    const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose, place, "HDF5 cannot open it");
    const Handle type(H5Aget_type(attribute.id()), H5Tclose, place, "HDF5 cannot read its type");
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    const H5T_class_t kind = H5Tget_class(type.id());
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Sget_simple_extent_npoints(space.id()) != 1) return std::nullopt;
    double number = 0;
    hdf5::check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &number), place, "HDF5 cannot read it");
    return number;
}

/// The root attribute `record_version`; 1 without it.
int read_version(const Handle& root) {
    const std::string name = "record_version", place = hdf5::attribute_place(root, name);
    if (!hdf5::has_attribute(root, name)) return 1;
    const std::optional<double> version = read_any_number(root, name);
    if (!version) throw Error(place, "is not one number", "Write 2");
    if (*version != 1 && *version != 2)
        throw Error(place, "is " + to_text(*version), "Write 2, or use a newer credence if there is such a version");
    return static_cast<int>(*version);
}

/// Sets trials and steps by extents [..., size], `rank` of them with trials.
void set_extents(const PlacedExtents& leading, std::size_t rank, const std::string& written, RecordLayout& layout) {
    const Extents& extents = leading.extents;
    if (extents.size() != rank && extents.size() + 1 != rank)
        throw Error(leading.place, "is " + extents_text(extents), "Write it as " + written);
    layout.single = extents.size() + 1 == rank;
    const std::size_t step = layout.single ? 0 : 1;
    if (!layout.single) require_between(leading, 0, H5S_UNLIMITED, "trials");
    require_between(leading, step, largest_record_steps, "steps");
    layout.shape.trials = layout.single ? 1 : static_cast<std::int64_t>(extents[0]);
    layout.shape.steps = static_cast<int>(extents[step]);
}

void set_state(const PlacedExtents& error, RecordLayout& layout) {
    set_extents(error, 3, "[trial, step, n]", layout);
    require_between(error, error.extents.size() - 1, largest_record_state, "components");
    layout.shape.n = static_cast<int>(error.extents.back());
}

void open_innovations(const Handle& root, RecordDatasets& data) {
    if (auto dataset = optional_dataset(root, "innovation", "innovation_covariance")) data.innovation.emplace(std::move(*dataset));
    if (auto dataset = optional_dataset(root, "innovation_covariance", "innovation")) data.innovation_covariance.emplace(std::move(*dataset));
}

void add_innovations(const Handle& root, const PlacedExtents& leading, RecordLayout& layout) {
    RecordDatasets& data = layout.data;
    if (!data.innovation) return;
    const PlacedExtents innovation = placed(*data.innovation);
    require_squares(innovation, *data.innovation_covariance, "innovation", "innovation_covariance");
    require_same_steps(leading, *data.innovation, leading.extents.size(),
                       "Write it as [trial, step, row], with NaN where a step has no such row");
    require_between(innovation, leading.extents.size() - 1, largest_record_rows, "rows");
    layout.shape.m = static_cast<int>(innovation.extents.back());
    layout.shape.innovation_epsilon = data.innovation_covariance->epsilon();
    if (layout.shape.version == 2 && hdf5::has_attribute(root, "row_groups"))
        layout.shape.row_groups = parse_row_groups(hdf5::read_any_text(root, "row_groups"), layout.shape.m,
                                                   hdf5::attribute_place(root, "row_groups"));
}

/// The dataset `steps` [trial]: the number of steps of each run.
std::vector<int> read_steps(const RealDataset& dataset, const RecordShape& shape) {
    const Extents& extents = dataset.extents();
    const Extents all{static_cast<hsize_t>(shape.trials)};
    if (extents != all)
        throw Error(dataset.place(), "does not fit: it is " + extents_text(extents) + ", and there are " +
                                         std::to_string(shape.trials) + " trials",
                    "Write it as [trial], the number of steps of each");
    std::vector<double> values(static_cast<std::size_t>(shape.trials));
    dataset.read({0}, all, values);
    std::vector<int> steps;
    for (const double value : values) {
        if (!(value >= 1 && value <= shape.steps && value == std::nearbyint(value)))
            throw Error(dataset.place(),
                        "trial " + std::to_string(steps.size()) + " (counted from 0) has " + to_text(value) + " steps",
                        "Write whole numbers from 1 to " + std::to_string(shape.steps) + ", the steps of the file");
        steps.push_back(static_cast<int>(value));
    }
    return steps;
}

/// The dataset `time` [step] or [trial, step]: it increases from step to step.
void check_time(const RealDataset& dataset, const RecordLayout& layout) {
    const Extents& extents = dataset.extents();
    const hsize_t trials = static_cast<hsize_t>(layout.shape.trials), steps = static_cast<hsize_t>(layout.shape.steps);
    const bool common = extents == Extents{steps};
    if (!common && extents != Extents{trials, steps})
        throw Error(dataset.place(), "does not fit: it is " + extents_text(extents) + ", and there are " +
                                         std::to_string(trials) + " trials and " + std::to_string(steps) + " steps",
                    "Write it as [step], or as [trial, step]");
    std::vector<double> values(steps);
    for (hsize_t trial = 0; trial < (common ? 1 : trials); ++trial) {
        dataset.read(common ? Extents{0} : Extents{trial, 0}, common ? Extents{steps} : Extents{1, steps}, values);
        double before = -std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < values.size() && layout.shape.covers(static_cast<std::int64_t>(trial), static_cast<int>(k)); ++k) {
            if (std::isnan(values[k])) continue;
            if (!(values[k] > before) || std::isinf(values[k]))
                throw Error(dataset.place(),
                            (common ? "" : "trial " + std::to_string(trial) + ", ") + "step " + std::to_string(k) +
                                " (counted from 0) has " + to_text(values[k]) + ", and the time before is " + to_text(before),
                            "Write times that increase from step to step, in seconds");
            before = values[k];
        }
    }
}

RecordLayout open_version_1(const Handle& root) {
    RecordLayout layout;
    RecordDatasets& data = layout.data;
    data.error.emplace(with_dataset(root, "error"), "error");
    data.covariance.emplace(with_dataset(root, "covariance"), "covariance");
    open_innovations(root, data);
    const PlacedExtents error = placed(*data.error);
    require_squares(error, *data.covariance, "error", "covariance");
    set_state(error, layout);
    layout.shape.groups = read_blocks(root, layout.shape.n);
    data.own.resize(layout.shape.groups.size());
    layout.shape.covariance_epsilon = data.covariance->epsilon();
    add_innovations(root, error, layout);
    if (hdf5::has_link(root, "steps"))
        layout.shape.declared = read_steps(RealDataset(root, "steps", hdf5::Numbers::any), layout.shape);
    return layout;
}

/// Opens `error`, or `truth` and `estimate`. Returns its extents [..., n], empty without errors.
PlacedExtents open_errors(const Handle& root, RecordDatasets& data) {
    if (hdf5::has_link(root, "error")) {
        if (hdf5::has_link(root, "estimate"))
            throw Error(hdf5::place_of(root, "estimate"), "is there, and `error` too", "Write `error`, or `truth` and `estimate`");
        data.error.emplace(with_dataset(root, "error"), "error");
        return placed(*data.error);
    }
    if (auto dataset = optional_dataset(root, "truth", "estimate")) data.truth.emplace(std::move(*dataset));
    if (auto dataset = optional_dataset(root, "estimate", "truth")) data.estimate.emplace(std::move(*dataset));
    if (!data.estimate) return {};
    data.manifold = Manifold::read(root);
    PlacedExtents estimate = placed(*data.estimate);
    const auto q = static_cast<hsize_t>(data.manifold->coordinates());
    for (const RealDataset* dataset : {&*data.estimate, &*data.truth})
        if (dataset->extents().empty() || dataset->extents().back() != q || dataset->extents() != estimate.extents)
            throw Error(dataset->place(),
                        "does not fit: it is " + extents_text(dataset->extents()) + ", and the manifold has " +
                            std::to_string(q) + " coordinates",
                        "Write truth and estimate as [trial, step, " + std::to_string(q) + "]");
    estimate.extents.back() = static_cast<hsize_t>(data.manifold->dimension());
    return estimate;
}

/// `covariance` [..., n, n], or [..., n] variances.
void open_covariance(const Handle& root, const PlacedExtents& error, RecordLayout& layout) {
    if (!hdf5::has_link(root, "covariance")) return;
    RealDataset& covariance = layout.data.covariance.emplace(with_dataset(root, "covariance"), "covariance");
    layout.shape.covariance_epsilon = covariance.epsilon();
    layout.shape.has_variances = covariance.extents() == error.extents;
    if (!layout.shape.has_variances) require_squares(error, covariance, "error", "covariance");
}

/// A group's own dataset: `covariance` [..., d, d] or `nees` [...], in /group/NAME.
void open_own(const Handle& group, const PlacedExtents& leading, std::size_t b, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    const bool covariance = hdf5::has_link(group, "covariance"), nees = hdf5::has_link(group, "nees");
    if (covariance == nees)
        throw Error(hdf5::place_of(group), covariance ? "has a covariance and a NEES" : "has neither `covariance` nor `nees`",
                    "Write one of them");
    RealDataset& dataset = layout.data.own[b].emplace(group, covariance ? "covariance" : "nees");
    shape.sources[b] = covariance ? GroupSource::own : GroupSource::nees;
    shape.group_epsilons[b] = dataset.epsilon();
    if (nees) return require_same_steps(leading, dataset, leading.extents.size() - 1, "Write it as [trial, step]");
    PlacedExtents error = leading;
    error.extents.back() = static_cast<hsize_t>(shape.groups[b].count);
    require_squares(error, dataset, "error", "covariance");
}

/// The attribute `dimension` of a NEES.
int read_dimension(const RealDataset& dataset, const Handle& object) {
    const std::string name = "dimension", place = hdf5::attribute_place(object, name);
    if (!hdf5::has_attribute(object, name)) throw Error(place, "is missing", "Write the number of components of " + dataset.place());
    const double dimension = read_any_number(object, name).value_or(0);
    if (!(dimension >= 1 && dimension <= static_cast<double>(largest_record_state) && dimension == std::nearbyint(dimension)))
        throw Error(place, "is no number of components", "Write a whole number from 1 to 1000");
    return static_cast<int>(dimension);
}

/// The index of a group by its name; the number of groups where there is none of that name.
std::size_t find_group(const RecordShape& shape, const std::string& name) {
    const auto found = std::ranges::find(shape.groups, name, &ComponentGroup::name);
    return static_cast<std::size_t>(found - shape.groups.begin());
}

void set_sources(GroupSource source, RecordLayout& layout) {
    layout.shape.sources.assign(layout.shape.groups.size(), source);
    layout.shape.group_epsilons.assign(layout.shape.groups.size(), 0);
    layout.data.own.resize(layout.shape.groups.size());
}

/// Of variances each component is judged by itself, whether the record names it as a group or not.
void add_single_groups(const Handle& root, RecordShape& shape) {
    std::vector<char> alone(static_cast<std::size_t>(shape.n), 0);
    for (const ComponentGroup& group : shape.groups)
        if (group.count == 1) alone[static_cast<std::size_t>(group.component(0))] = 1;
    for (int j = 0; j < shape.n; ++j) {
        if (shape.n == 1 || alone[static_cast<std::size_t>(j)]) continue;
        const std::string name = component_name(shape, j);
        if (find_group(shape, name) < shape.groups.size())
            throw Error(hdf5::attribute_place(root, "groups"), "`" + name + "` is a component's name as well",
                        "Use another name for the group");
        shape.groups.push_back({name, j, 1});
    }
}

/// The datasets of /group/NAME.
void open_groups(const Handle& root, const PlacedExtents& error, RecordLayout& layout) {
    if (!hdf5::has_link(root, "group")) return;
    const Handle all = hdf5::open_group(root, "group");
    for (const std::string& name : hdf5::sorted_link_names(all)) {
        const std::size_t b = find_group(layout.shape, name);
        if (b == 0 || b == layout.shape.groups.size())
            throw Error(hdf5::place_of(all, name), "is no group of components",
                        "Name its components in the root's attribute `groups`");
        const Handle group = hdf5::open_group(all, name);
        open_own(group, error, b, layout);
        if (layout.shape.sources[b] == GroupSource::nees &&
            read_dimension(*layout.data.own[b], Handle(H5Dopen2(group.id(), "nees", H5P_DEFAULT), H5Dclose, "", "")) !=
                layout.shape.groups[b].count)
            throw Error(hdf5::place_of(group, "nees"), "has another dimension than its group",
                        "Write " + std::to_string(layout.shape.groups[b].count));
    }
}

void require_something(const Handle& root, const RecordShape& shape) {
    for (std::size_t b = 1; b < shape.groups.size(); ++b)
        if (shape.sources[b] == GroupSource::nothing)
            throw Error(hdf5::attribute_place(root, "groups"), "nothing to judge `" + shape.groups[b].name + "` by",
                        "Write /covariance, or /group/" + shape.groups[b].name + "/covariance or nees");
    if (shape.groups.size() == 1 && shape.sources[0] == GroupSource::nothing)
        throw Error(hdf5::place_of(root, "covariance"), "is missing",
                    "Write it as [trial, step, n, n], or as [trial, step, n] where there are variances only, or write "
                    "covariances of groups, /group/NAME/covariance");
}

/// Opens /nees, the NEES of the whole state. Returns its dimension.
int open_nees(const Handle& root, RecordDatasets& data) {
    RealDataset& nees = data.own[0].emplace(with_dataset(root, "nees"), "nees");
    return read_dimension(nees, Handle(H5Dopen2(root.id(), "nees", H5P_DEFAULT), H5Dclose, nees.place(), "cannot be opened"));
}

/// A record with errors.
void open_states(const Handle& root, const PlacedExtents& error, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    set_state(error, layout);
    shape.components = read_components(root, shape.n);
    shape.groups = read_groups(root, shape.n);
    open_covariance(root, error, layout);
    if (shape.has_variances) add_single_groups(root, shape);
    set_sources(!layout.data.covariance ? GroupSource::nothing
                : shape.has_variances   ? GroupSource::variances
                                        : GroupSource::joint,
                layout);
    if (hdf5::has_link(root, "nees")) {
        if (shape.has_joint())
            throw Error(hdf5::place_of(root, "nees"), "is there, and a joint covariance too", "Write one of them");
        if (open_nees(root, layout.data) != shape.n)
            throw Error(hdf5::place_of(root, "nees"), "has another dimension than the error", "Write " + std::to_string(shape.n));
        require_same_steps(error, *layout.data.own[0], error.extents.size() - 1, "Write it as [trial, step]");
        shape.sources[0] = GroupSource::nees;
    }
    open_groups(root, error, layout);
    require_something(root, shape);
}

/// A record of NEES alone: /nees, and /group/NAME/nees of groups that need not be named elsewhere. Returns the extents
/// that an error of one component would have.
PlacedExtents open_nees_alone(const Handle& root, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    std::vector<std::string> names;
    if (hdf5::has_link(root, "group")) names = hdf5::sorted_link_names(hdf5::open_group(root, "group"));
    if (names.empty() && !hdf5::has_link(root, "nees"))
        throw Error(hdf5::place_of(root, "error"), "is missing",
                    "Write `error` [trial, step, n], `truth` and `estimate` with the attribute `manifold`, or a NEES "
                    "[trial, step] with the attribute `dimension`, /nees or /group/NAME/nees");
    shape.groups = {{"all", 0, 0}};
    for (const std::string& name : names) {
        require_group_name(name, "group", hdf5::place_of(root, "group"));
        shape.groups.push_back({name, 0, 0});
    }
    set_sources(GroupSource::nees, layout);
    if (hdf5::has_link(root, "nees")) shape.n = open_nees(root, layout.data);
    else shape.sources[0] = GroupSource::nothing;
    int all = 0;
    for (std::size_t b = 1; b < shape.groups.size(); ++b) {
        const Handle group = hdf5::open_group(hdf5::open_group(root, "group"), shape.groups[b].name);
        RealDataset& nees = layout.data.own[b].emplace(with_dataset(group, "nees"), "nees");
        shape.groups[b].count = read_dimension(nees, Handle(H5Dopen2(group.id(), "nees", H5P_DEFAULT), H5Dclose, nees.place(), "cannot be opened"));
        all += shape.groups[b].count;
    }
    if (shape.n == 0) shape.n = std::min(all, static_cast<int>(largest_record_state));
    shape.groups[0].count = shape.n;
    const RealDataset& first = layout.data.own[0] ? *layout.data.own[0] : *layout.data.own[1];
    PlacedExtents leading = placed(first);
    set_extents(leading, 2, "[trial, step]", layout);
    leading.extents.push_back(1);
    for (const auto& nees : layout.data.own)
        if (nees) require_same_steps(leading, *nees, leading.extents.size() - 1, "Write it as [trial, step]");
    return leading;
}

RecordLayout open_version_2(const Handle& root) {
    RecordLayout layout;
    RecordDatasets& data = layout.data;
    layout.shape.version = 2;
    open_innovations(root, data);
    PlacedExtents leading = open_errors(root, data);
    layout.shape.has_errors = !leading.extents.empty();
    if (layout.shape.has_errors) open_states(root, leading, layout);
    else leading = open_nees_alone(root, layout);
    add_innovations(root, leading, layout);
    if (hdf5::has_link(root, "steps"))
        layout.shape.declared = read_steps(RealDataset(root, "steps", hdf5::Numbers::any), layout.shape);
    if (hdf5::has_link(root, "time")) check_time(RealDataset(root, "time", hdf5::Numbers::any), layout);
    return layout;
}

}  // namespace

RecordLayout open_record(const Handle& root) { return read_version(root) == 1 ? open_version_1(root) : open_version_2(root); }

}  // namespace credence
