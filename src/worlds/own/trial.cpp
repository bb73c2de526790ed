// What a user's own world declares.

#include <credence/detail/own_simulation.hpp>

#include <credence/error.hpp>
#include "scenario/state_series.hpp"
#include <credence/text.hpp>

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace credence {

namespace {

constexpr int largest_state = 1000, largest_innovation = 2000;

/// Whether files hold a value of an integer column as it is.
bool is_stored_integer(double value) {
    return std::abs(value) <= std::numeric_limits<std::int32_t>::max() && value == std::nearbyint(value);
}

bool is_word(const std::string& text) { return !text.empty() && text.find_first_of(" \t\n") == std::string::npos; }

InputError refused(const Scenario& scenario, const std::string& why, const std::string& remedy) {
    return InputError("cannot use world " + printable(scenario.world), printable(why), remedy);
}

/// `what` is listed: the names must be there, be names, and differ.
template <class Named, class Name>
void check_names(const Scenario& scenario, const std::string& what, const std::vector<Named>& all, Name name,
                 bool (*is_name)(const std::string&) = names_something) {
    std::vector<std::string> names;
    for (const Named& one : all) names.push_back(name(one));
    const std::string remedy = "Give its " + what + " other names";
    if (names.empty()) throw refused(scenario, "it has no " + what, "Name one or more");
    for (const std::string& one : names)
        if (!is_name(one))
            throw refused(scenario, "'" + one + "' among its " + what + " is no name of letters, digits, _ and -",
                          remedy);
    std::ranges::sort(names);
    if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
        throw refused(scenario, *twice + " is there twice among its " + what, remedy);
}

/// Whether a text is `section.key`, of names.
bool names_key(const std::string& text) {
    const std::vector<std::string> parts = split_list(text, '.');
    return parts.size() > 1 && std::ranges::all_of(parts, names_something) && joined(parts, ".") == text;
}

/// Each key must be read back from a file to the same value, by this program and by others.
void check_keys(const Scenario& scenario) {
    check_names(
        scenario, "keys", scenario.settings, [](const Setting& one) { return one.key; }, names_key);
    for (const auto& [key, value, later_default] : scenario.settings) {
        if (key.starts_with("sweep.") || key.starts_with("published."))
            throw refused(scenario, key + " means something else in every world", "Give the key another section");
        if (value.find_first_of("#\n\r") != std::string::npos || trimmed(value) != value)
            throw refused(scenario, key + "=" + value + " cannot be read back from a file",
                          "Write its values without # and without blanks at their ends");
    }
}

void check_columns(const Scenario& scenario, const OwnReport& report) {
    check_names(scenario, "columns", own_columns(scenario, report), [](const Column& column) { return column.name; });
    for (const Column& column : report.columns) {
        if (column.type == ColumnType::status)
            throw refused(scenario, "column " + column.name + " has the type status", "Make it an integer");
        if (column.type == ColumnType::integer && !is_stored_integer(column.fill))
            throw refused(scenario, "column " + column.name + " is filled with " + to_text(column.fill),
                          "Fill it with a whole number of 32 bits");
        if (!is_word(column.unit) || column.unit.find(',') != std::string::npos)
            throw refused(scenario, "the unit '" + column.unit + "' of column " + column.name + " is no word",
                          "Write one such as m/s, or 1");
    }
}

bool is_part_of(const ComponentGroup& group, int n) {
    if (group.count < 1 || (!group.contiguous() && group.components.size() != static_cast<std::size_t>(group.count)))
        return false;
    for (int i = 0; i < group.count; ++i)
        if (group.component(i) < 0 || group.component(i) >= n) return false;
    return true;
}

}  // namespace

std::vector<Column> own_columns(const Scenario& scenario, const OwnReport& report) {
    const std::string unit = squared_unit(scenario.components, scenario.groups.front());
    const auto real = [&](const std::string& name, const std::string& long_name, const std::string& of,
                          const ColumnPlaces& places = {}) {
        return Column{name, long_name, of, ColumnType::real, nan, places};
    };
    std::vector<Column> columns{real("trace_P", "trace of the covariance after the last step", unit)};
    columns.insert(columns.end(), report.columns.begin(), report.columns.end());
    columns.push_back(
        real("squared_error", "squared error of the whole state, summed over the steps", unit, {.sweep = false}));
    columns.push_back(real("nees_ratio", "mean over the steps of NEES / state dimension", "1", {.sweep_pairs = false}));
    columns.push_back(
        real("nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", {.sweep_pairs = false}));
    columns.push_back(
        real("mean_trace_P", "mean over the steps of the trace of the covariance", unit, {false, false, false}));
    columns.push_back(log_score_column());
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    return columns;
}

std::vector<Series> own_series(const Scenario& scenario, const OwnReport& report) {
    return StateSeries(scenario.components, scenario.groups,
                        report.largest_innovation > 0 ? Innovations::given : Innovations::none)
        .list;
}

void check_declared(const Scenario& scenario, const OwnReport& report) {
    const auto n = static_cast<int>(scenario.components.size());
    if (!names_something(scenario.world))
        throw refused(scenario, "its name is none of letters, digits, _ and -", "Give it another name");
    check_keys(scenario);
    check_names(
        scenario, "arms", scenario.arms, [](const std::string& arm) { return arm; }, names_arm);
    check_names(scenario, "components", scenario.components, [](const Component& one) { return one.name; });
    if (n > largest_state)
        throw refused(scenario, "its state has " + std::to_string(n) + " components", "Give at most 1000");
    for (const Component& component : scenario.components)
        if (!is_word(component.unit))
            throw refused(scenario, "the unit '" + component.unit + "' of " + component.name + " is no word",
                          "Write one such as m/s, or 1");
    check_names(scenario, "groups", scenario.groups, [](const ComponentGroup& one) { return one.name; });
    for (const ComponentGroup& group : scenario.groups)
        if (!is_part_of(group, n))
            throw refused(scenario,
                          "group " + group.name + " is not in the state of " + std::to_string(n) + " components",
                          "Give it components of the state, each once");
    const int m = report.largest_innovation;
    if (m < 0 || m > largest_innovation)
        throw refused(scenario, "its innovations have " + std::to_string(m) + " rows",
                      "Give 0 to 2000 as innovation_rows");
    check_columns(scenario, report);
}

}  // namespace credence
