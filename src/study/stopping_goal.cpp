// Parsing of goals, and their columns in a study.

#include "study/stopping.hpp"

#include "base/wording.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

const char* const how_to_write = "Write METRIC=0.01, METRIC=0.5% or METRIC[ARM-ARM]=0.01";

InputError refused(const std::string& goal, const std::string& why, const std::string& remedy = how_to_write) {
    return invalid_value(as_option("until"), goal, why, remedy);
}

void parse_half_width(StoppingGoal& goal, std::string width) {
    if (width.ends_with('%')) {
        goal.kind = WidthKind::relative;
        width = trimmed(width.substr(0, width.size() - 1));
    }
    const std::optional<double> number = to_number(width);
    if (!number) throw refused(goal.text, "the half-width is not a number");
    goal.half_width = goal.kind == WidthKind::relative ? *number / 100 : *number;
    if (!(goal.half_width > 0) || std::isinf(goal.half_width))
        throw refused(goal.text, "the half-width must be above 0 and finite");
}

/// Removes `[ARM-ARM]` from the metric.
void parse_arms(StoppingGoal& goal) {
    const std::size_t open = goal.metric.find('[');
    if (open == std::string::npos) return;
    if (goal.metric.find(']') != goal.metric.size() - 1) throw refused(goal.text, "the [ is not closed before the =");
    const std::vector<std::string> arms = split_list(goal.metric.substr(open + 1, goal.metric.size() - open - 2), '-');
    if (arms.size() != 2 || arms[0].empty() || arms[1].empty())
        throw refused(goal.text, "two arms with a - between them stand in [ ]");
    goal.metric = trimmed(goal.metric.substr(0, open));
    goal.minuend = arms[0];
    goal.subtrahend = arms[1];
}

std::size_t metric_column(const StoppingGoal& goal, const std::vector<Column>& columns) {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!is_reported(columns[c])) continue;
        if (columns[c].name == goal.metric) return c;
        names.push_back(columns[c].name);
    }
    throw refused(goal.text, "there is no column " + goal.metric,
                  did_you_mean(goal.metric, names) + "There are " + joined(names));
}

/// The scenario's arm of that name, or its only arm of that controller; nothing where it has no such arm.
const ArmResults* arm_named(const StoppingGoal& goal, const ScenarioResults& results, const std::string& name) {
    const std::vector<const ArmResults*> meant = arms_meant(results, name);
    if (meant.size() > 1) {
        std::vector<std::string> names;
        for (const ArmResults* arm : meant) names.push_back(arm->name);
        throw refused(goal.text, "scenario " + results.scenario.name + " has several arms " + name,
                      "Name one of " + joined(names));
    }
    return meant.empty() ? nullptr : meant.front();
}

/// The message for a pair of arms that no scenario has.
InputError no_such_pair(const StoppingGoal& goal, const Study& study) {
    std::vector<std::string> known;
    for (const ScenarioResults& results : study.scenarios)
        for (const ArmResults& arm : results.arms)
            for (const std::string& name : {arm.name, controller_of(arm.name)})
                if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    for (const std::string& name : {goal.minuend, goal.subtrahend})
        if (std::find(known.begin(), known.end(), name) == known.end())
            return refused(goal.text, "no scenario has an arm " + name,
                           did_you_mean(name, known) + "There are " + joined(known));
    return refused(goal.text, "no scenario has both " + goal.minuend + " and " + goal.subtrahend,
                   "There are " + joined(known));
}

}  // namespace

StoppingGoal parse_goal(const std::string& text) {
    StoppingGoal goal;
    goal.text = text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw refused(text, "there is no = in it");
    goal.metric = trimmed(text.substr(0, equals));
    parse_half_width(goal, trimmed(text.substr(equals + 1)));
    parse_arms(goal);
    if (goal.metric.empty()) throw refused(text, "there is no name before the =");
    return goal;
}

std::vector<StoppingSubject> subjects_of(const StoppingGoal& goal, const Study& study) {
    std::vector<StoppingSubject> subjects;
    for (const ScenarioResults& results : study.scenarios) {
        const std::size_t column = metric_column(goal, results.columns);
        if (!goal.is_pair()) {
            for (const ArmResults& arm : results.arms) subjects.push_back({&results, column, &arm, nullptr});
            continue;
        }
        const ArmResults* const minuend = arm_named(goal, results, goal.minuend);
        const ArmResults* const subtrahend = arm_named(goal, results, goal.subtrahend);
        if (minuend != nullptr && minuend == subtrahend)
            throw refused(goal.text, "an arm less itself is 0", "Name two arms that differ");
        if (minuend != nullptr && subtrahend != nullptr) subjects.push_back({&results, column, minuend, subtrahend});
    }
    if (subjects.empty()) throw no_such_pair(goal, study);
    return subjects;
}

void check_goals(const std::vector<StoppingGoal>& goals, const Study& study) {
    for (const StoppingGoal& goal : goals) subjects_of(goal, study);
}

}  // namespace credence
