// What a user's own world declares.

#include <credence/detail/own_simulation.hpp>

#include <credence/error.hpp>
#include "scenario/state_series.hpp"
#include <credence/text.hpp>

#include "base/nan.hpp"

#include <algorithm>
#include <stdexcept>

namespace credence {

namespace {

constexpr int largest_state = 1000;

bool is_word(const std::string& text) {
    return !text.empty() && text.find_first_of(" \t\n") == std::string::npos;
}

/// `what` is wrong with a list of names.
template <class Named, class Name>
void check_names(const std::string& world, const std::string& what, const std::vector<Named>& all, Name name) {
    std::vector<std::string> names;
    for (const Named& one : all) names.push_back(name(one));
    std::sort(names.begin(), names.end());
    const bool twice = std::adjacent_find(names.begin(), names.end()) != names.end();
    if (names.empty() || twice || !std::all_of(names.begin(), names.end(), names_something))
        throw std::invalid_argument("world " + world + ": its " + what +
                                    " need names that differ, of letters, digits, _ and -.");
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
    const auto real = [&](const std::string& name, const std::string& long_name, const std::string& of) {
        return Column{name, long_name, of, ColumnType::real, nan};
    };
    std::vector<Column> columns{real("trace_P", "trace of the covariance after the last step", unit)};
    columns.insert(columns.end(), report.columns.begin(), report.columns.end());
    columns.push_back(real("squared_error", "squared error of the whole state, summed over the steps", unit));
    columns.push_back(real("nees_ratio", "mean over the steps of NEES / state dimension", "1"));
    columns.push_back(real("nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1"));
    columns.push_back(real("mean_trace_P", "mean over the steps of the trace of the covariance", unit));
    for (Column& column : status_columns()) columns.push_back(std::move(column));
    check_names(scenario.world, "columns", columns, [](const Column& column) { return column.name; });
    return columns;
}

std::vector<Series> own_series(const Scenario& scenario, const OwnReport& report) {
    return StateSeries(scenario.components, scenario.groups,
                        report.largest_innovation > 0 ? Innovations::given : Innovations::none)
        .list;
}

void check_declared(const Scenario& scenario) {
    const auto n = static_cast<int>(scenario.components.size());
    check_names(scenario.world, "components", scenario.components, [](const Component& one) { return one.name; });
    check_names(scenario.world, "groups", scenario.groups, [](const ComponentGroup& one) { return one.name; });
    for (const std::string& arm : scenario.arms)
        if (!names_arm(arm))
            throw std::invalid_argument("world " + scenario.world + ": " + printable(arm) + " is no name for an arm.");
    if (scenario.arms.empty() || n > largest_state)
        throw std::invalid_argument("world " + scenario.world + ": it needs an arm, and a state of 1 to 1000.");
    for (const Component& component : scenario.components)
        if (!is_word(component.unit))
            throw std::invalid_argument("world " + scenario.world + ": a component's unit is one word, such as m/s.");
    for (const ComponentGroup& group : scenario.groups)
        if (!is_part_of(group, n))
            throw std::invalid_argument("world " + scenario.world + ": group " + group.name + " is not in the state.");
}

}  // namespace credence
