#include "scenario/state_series.hpp"

#include "numeric/chi_square.hpp"

#include <algorithm>

namespace credence {

std::string squared_unit(const std::vector<Component>& components, const ComponentGroup& group) {
    std::vector<std::string> units;
    for (int i = 0; i < group.count; ++i) {
        const std::string& unit = components[static_cast<std::size_t>(group.component(i))].unit;
        if (unit.empty()) return "unit of error squared";
        if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
    }
    std::string text;
    for (const std::string& unit : units)
        text += (text.empty() ? "" : " + ") + (unit == "1"                           ? unit
                                               : unit.find('/') == std::string::npos ? unit + "^2"
                                                                                     : "(" + unit + ")^2");
    return text;
}

std::vector<double> coverage_bounds(const std::vector<ComponentGroup>& groups) {
    std::vector<double> bounds;
    for (const ComponentGroup& group : groups)
        for (const double level : coverage_levels) bounds.push_back(stable_chi_square_quantile(level, group.count));
    return bounds;
}

std::string described(const ComponentGroup& group) { return group.name == "all" ? "the whole state" : group.name; }

std::string of_group(const std::string& name, const ComponentGroup& group) {
    return group.name == "all" ? name : name + "_" + group.name;
}

void add_nees(std::vector<Series>& list, const std::vector<ComponentGroup>& groups) {
    for (const ComponentGroup& group : groups)
        list.push_back({of_group("nees", group), "normalised estimation error squared of " + described(group), "1",
                        SeriesRole::nees, group.count, false, group.name, "", 0});
}

void add_nis(std::vector<Series>& list) {
    list.push_back(
        {"nis", "normalised innovation squared of all rows", "1", SeriesRole::nis, 0, false, "all", "nis_rows", 0});
    list.push_back({"nis_rows", "measurement rows", "1", SeriesRole::rows, 0, true, "all", "", 0});
}

void add_nis_of_rows(std::vector<Series>& list, const std::string& name) {
    list.push_back({"nis_" + name, "normalised innovation squared of " + name, "1", SeriesRole::nis, 0, false, name,
                    "nis_rows_" + name, 0});
    list.push_back({"nis_rows_" + name, "measurement rows of " + name, "1", SeriesRole::rows, 0, true, name, "", 0});
}

void add_squared_errors(std::vector<Series>& list, const std::vector<ComponentGroup>& groups, const UnitOf& unit_of) {
    for (const ComponentGroup& group : groups)
        list.push_back({of_group("squared_error", group), "squared error of " + described(group), unit_of(group),
                        SeriesRole::squared_error, group.count, false, group.name, "", 0});
}

void add_variances(std::vector<Series>& list, const std::vector<ComponentGroup>& groups, const UnitOf& unit_of,
                   const std::string& when) {
    for (const ComponentGroup& group : groups)
        list.push_back({group.name == "all" ? "trace_P_step" : of_group("variance", group),
                        "trace of the covariance of " + described(group) + when, unit_of(group), SeriesRole::variance,
                        group.count, false, group.name, "", 0});
}

void add_standardised_errors(std::vector<Series>& list, const std::vector<Component>& components) {
    for (const Component& component : components)
        list.push_back({"standardised_error_" + component.name,
                        "error of " + component.name + " over its predicted standard deviation", "1",
                        SeriesRole::standardised_error, 1, false, component.name, "", 0});
}

StateSeries::StateSeries(const std::vector<ComponentGroup>& groups, Innovations innovations,
                         const std::vector<std::string>& row_groups) {
    add_nees(list, groups);
    if (innovations == Innovations::given) {
        nis = list.size();
        rows = nis + 1;
        add_nis(list);
        for (const std::string& name : row_groups) add_nis_of_rows(list, name);
    }
    squared_error = variance = standardised_error = list.size();
}

StateSeries::StateSeries(const std::vector<Component>& components, const std::vector<ComponentGroup>& groups,
                         Innovations innovations, const std::vector<std::string>& row_groups)
    : StateSeries(groups, innovations, row_groups) {
    const UnitOf unit_of = [&](const ComponentGroup& group) { return squared_unit(components, group); };
    add_squared_errors(list, groups, unit_of);
    variance = list.size();
    add_variances(list, groups, unit_of, "");
    standardised_error = list.size();
    add_standardised_errors(list, components);
}

}  // namespace credence
