// The covariance of the truth's own errors [docs/statistics.md, Uncertain truth].

#include <algorithm>
#include <credence/error.hpp>
#include <credence/text.hpp>
#include <map>
#include <numbers>

#include "record/presence.hpp"
#include "record/layout/parts.hpp"

namespace credence {

namespace {

const std::string sigma_name = "truth_sigma", covariance_name = "truth_covariance", dependent_name = "truth_dependent";

/// One matrix, or one for each step, as that of every trial and step.
DatasetPointer repeated(const RecordExtents& extents, const std::vector<double>& matrix,
                        const DatasetPointer& by_step = nullptr) {
    const auto read = [=](const RecordExtents& first, const RecordExtents& count, std::vector<double>& values) {
        std::vector<double> one = matrix;
        if (by_step) {
            one.resize(count[1] * count[2] * count[3]);
            by_step->read({first.begin() + 1, first.end()}, {count.begin() + 1, count.end()}, one);
        }
        for (auto to = values.begin(); to != values.end(); to += std::ssize(one)) std::ranges::copy(one, to);
    };
    return std::make_shared<RecordDataset>(record_place(covariance_name), extents, 0, 1, read);
}

[[noreturn]] void refuse_sigma(const std::string& entry, const std::string& why, const std::string& remedy) {
    throw RecordError(record_attribute_place(sigma_name), "`" + printable(entry) + "` " + why, remedy);
}

std::string unit_of(const RecordShape& shape, int j) {
    return shape.components.empty() ? "" : shape.components[static_cast<std::size_t>(j)].unit;
}

/// How many of one unit the other is; nothing where that is not known.
std::optional<double> factor_of(const std::string& unit, const std::string& other) {
    constexpr double degree = std::numbers::pi / 180;
    static const std::map<std::string, double> units[]{
        {{"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"km", 1000}},
        {{"rad", 1}, {"mrad", 0.001}, {"deg", degree}, {"arcsec", degree / 3600}}};
    if (unit.empty() || unit == other) return 1;
    for (const auto& alike : units)
        if (alike.contains(unit) && alike.contains(other)) return alike.at(unit) / alike.at(other);
    return std::nullopt;
}

/// The components of the group or the component of this name; all for an empty one.
std::vector<int> components_named(const std::string& name, const std::string& entry, const RecordShape& shape) {
    if (name.empty()) return counted_up(shape.n);
    std::vector<std::string> names;
    for (const ComponentGroup& group : shape.groups)
        if (names.push_back(group.name); group.name == name) return members_of(group);
    for (int j = 0; j < shape.n; ++j)
        if (names.push_back(component_name(shape, j)); names.back() == name) return {j};
    refuse_sigma(entry, "names no group or component", "Give some of " + joined(names));
}

/// Sets the variances of an entry such as `0.005` or `heading=0.1deg`, which are -1 where they are not set.
void set_variances(const std::string& entry, const RecordShape& shape, std::vector<double>& variances) {
    const std::size_t equals = entry.find('=');
    const std::string text = equals == std::string::npos ? entry : entry.substr(equals + 1);
    std::size_t length = text.size();
    while (length > 0 && !to_number(text.substr(0, length))) --length;
    const double sigma = to_number(text.substr(0, length)).value_or(-1);
    if (!(sigma >= 0 && sigma < largest_number))
        refuse_sigma(entry, "has no standard deviation of at least 0",
                     "Write one for all components, such as 0.005, or by group, such as position=0.005,heading=0.1deg");
    const std::vector<int> components =
        components_named(equals == std::string::npos ? "" : entry.substr(0, equals), entry, shape);
    for (const int j : components) {
        const std::string own = unit_of(shape, j), first = unit_of(shape, components.front());
        if (equals != std::string::npos && own != first)
            refuse_sigma(entry, "is of components in " + first + " and in " + own, "Give those of each unit apart");
        const std::optional<double> factor = factor_of(text.substr(length), own);
        if (!factor)
            refuse_sigma(entry, "is in another unit than " + component_name(shape, j),
                         "Write a number in the unit of the error" + (own.empty() ? "" : ", " + own));
        double& variance = variances[static_cast<std::size_t>(j)];
        if (variance >= 0) refuse_sigma(entry, "is the second one of " + component_name(shape, j), "Give one");
        variance = sigma * *factor * sigma * *factor;
    }
}

/// A matrix [n, n] as it is, and variances [n] on its diagonal.
std::vector<double> as_matrix(const std::vector<double>& values, std::size_t n) {
    std::vector<double> matrix(n * n);
    for (std::size_t i = 0; i < values.size(); ++i) matrix[values.size() == n ? i * n + i : i] = values[i];
    return matrix;
}

/// `truth_covariance`: [n], [n, n], [step, n, n] or [trial, step, n, n].
DatasetPointer open_truth(const RecordSource& source, const RecordExtents& all, const RecordShape& shape) {
    const auto n = static_cast<std::uint64_t>(shape.n);
    if (source.has_attribute(sigma_name)) {
        std::vector<double> variances(n, -1);
        for (const std::string& entry : split_list(source.text(sigma_name))) set_variances(entry, shape, variances);
        std::ranges::replace(variances, -1.0, 0.0);
        return repeated(all, as_matrix(variances, n));
    }
    DatasetPointer dataset = source.open(covariance_name);
    const RecordExtents extents = dataset->extents();
    if (extents == all) return dataset;
    if (extents == RecordExtents{n} || extents == RecordExtents{n, n}) {
        std::vector<double> values(extents.size() == 1 ? n : n * n);
        dataset->read(RecordExtents(extents.size()), extents, values);
        return repeated(all, as_matrix(values, n));
    }
    if (extents != RecordExtents{static_cast<std::uint64_t>(shape.steps), n, n})
        throw RecordError(record_place(covariance_name),
                          "does not fit: it is " + extents_text(extents) + ", and the error has " +
                              std::to_string(shape.steps) + " steps of " + std::to_string(n) + " components",
                          "Write it as [n], [n, n], [step, n, n] or [trial, step, n, n]");
    return repeated(all, {}, dataset);
}

}  // namespace

void add_truth_covariance(const RecordSource& source, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    const bool sigma = source.has_attribute(sigma_name), covariance = source.has(covariance_name);
    const std::string place = sigma ? record_attribute_place(sigma_name) : record_place(covariance_name),
                      chart = "chart";
    shape.truth_depends = source.has_attribute(dependent_name) && source.text(dependent_name) == "yes";
    if (shape.truth_depends && !sigma && !covariance)
        throw RecordError(record_attribute_place(dependent_name), "says nothing without the truth's covariance",
                          "Write truth_sigma or truth_covariance, too");
    if (!sigma && !covariance) return;
    if (sigma && covariance)
        throw RecordError(place, "is there, and " + record_place(covariance_name) + ", too", "Write one of them");
    if (shape.of_innovations) throw RecordError(place, "is of a truth, and the record has none", "Leave it out");
    if (!shape.has_errors || std::ranges::count(shape.sources, GroupSource::nees) > 0)
        throw RecordError(place, "cannot be added to the covariance behind a NEES", "Write errors and covariances");
    if (covariance && source.has_attribute(chart, covariance_name) && source.has_attribute(chart, "") &&
        source.text(chart, covariance_name) != source.text(chart, ""))
        throw RecordError(record_attribute_place(chart, covariance_name), "is not that of the error",
                          "Write it in the chart of the error");
    const auto n = static_cast<std::uint64_t>(shape.n), steps = static_cast<std::uint64_t>(shape.steps);
    RecordExtents all{static_cast<std::uint64_t>(shape.trials), steps, n, n};
    if (layout.single) all.erase(all.begin());
    layout.data.truth_covariance = open_truth(source, all, shape);
    shape.has_truth_covariance = true;
}

}  // namespace credence
