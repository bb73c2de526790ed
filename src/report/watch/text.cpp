// A snapshot of a run, as text and as JSON.

#include "report/watch/watch.hpp"

#include <credence/error.hpp>

#include "report/format.hpp"
#include "report/data/json.hpp"

#include <algorithm>

namespace credence {

namespace {

std::string of_text(std::int64_t done, std::int64_t asked) {
    return std::to_string(done) + (done == asked ? "" : " of " + std::to_string(asked));
}

std::string shard_text(const Snapshot& look) {
    if (look.shard.count == 1) return "";
    return ", shard " + std::to_string(look.shard.index) + "/" + std::to_string(look.shard.count) + " of " +
           std::to_string(look.trials) + " trials a scenario";
}

/// The state of the run.
std::string state_text(const Snapshot& look) {
    const std::string trials = of_text(look.trials_done(), look.trials_asked()) + " trials";
    switch (look.state) {
        case RunState::begun: return "begun, nothing committed yet";
        case RunState::complete: return "complete, " + trials;
        case RunState::incomplete:
            return (look.shard.count > 1 ? "a whole part, " + trials : "not all there, " + trials) + shard_text(look);
        case RunState::running: break;
    }
    const double share = 100 * static_cast<double>(look.trials_done()) /
                         static_cast<double>(std::max<std::int64_t>(1, look.trials_asked()));
    std::string text = "running, " + trials + " (" + number(share, 0) + " %)" + shard_text(look);
    if (look.trials_per_second) text += "; " + number(*look.trials_per_second, 0) + " trials/s";
    if (const std::optional<double> left = look.time_left()) text += ", " + duration_text(*left) + " left";
    return text + "; last commit " + duration_text(look.seconds_since_commit) + " ago";
}

/// Advice where the run may have ended without finishing.
std::string advice(const Snapshot& look) {
    constexpr double long_time = 60;
    if (look.state == RunState::incomplete && look.shard.count == 1)
        return "A run that was stopped goes on with --resume; parts are joined by `credence merge`.\n";
    if (look.ended() || look.seconds_since_commit < long_time) return "";
    return std::string(look.trials_done() < look.trials_asked() ? "Nothing has been committed for a while"
                                                                : "All is committed, and the results file is due") +
           ". If the run is dead, the same command with --resume goes on.\n";
}

std::string units_text(const WatchedScenario& scenario) {
    std::string text;
    for (const Column& column : scenario.columns)
        if (!column.unit.empty() && column.unit != "1") text += ", " + column.name + " [" + column.unit + "]";
    return text;
}

std::string figure_text(const Moments& moments) {
    return moments.count > 0 ? with_interval(moments.mean, t_interval(moments)) : "-";
}

void add_scenario(TextTable& table, const WatchedScenario& scenario) {
    if (scenario.trials == 0)
        return table.line(wrapped(scenario.name + ": not run yet, " + std::to_string(scenario.trials_asked) + " trials asked for"));
    table.line(wrapped(scenario.name + ": " + of_text(scenario.trials, scenario.trials_asked) + " trials, " +
                       of_text(scenario.blocks, scenario.blocks_asked) + " blocks" + units_text(scenario)));
    for (const WatchedArm& arm : scenario.arms) {
        std::vector<std::string> cells{arm.name};
        for (const Moments& column : arm.columns) cells.push_back(figure_text(column));
        cells.push_back(std::to_string(arm.failed + arm.diverged));
        table.row(std::move(cells));
    }
    for (const WatchedArm& arm : scenario.arms)
        if (!arm.other.empty()) table.row({arm.name + " - " + arm.other, figure_text(arm.difference)});
}

Json moments_json(const Moments& moments) {
    const Interval ci95 = t_interval(moments);
    return {{"mean", moments.mean},
            {"se", moments.standard_error},
            {"ci95", interval_json(ci95)},
            {"sd", moments.standard_deviation},
            {"n", static_cast<std::int64_t>(moments.count)}};
}

const char* state_name(RunState state) {
    switch (state) {
        case RunState::begun: return "begun";
        case RunState::running: return "running";
        case RunState::complete: return "complete";
        case RunState::incomplete: break;
    }
    return "incomplete";
}

Json arm_json(const Snapshot& look, const WatchedScenario& scenario, const WatchedArm& arm) {
    Json json{{"scenario", scenario.name},       {"arm", arm.name},
              {"state", state_name(look.state)}, {"trials", scenario.trials},
              {"trials_asked", scenario.trials_asked}, {"blocks", scenario.blocks},
              {"blocks_asked", scenario.blocks_asked}, {"failed", arm.failed},
              {"diverged", arm.diverged},        {"failed_trials", arm.failed + arm.diverged}};
    for (std::size_t f = 0; f < arm.columns.size(); ++f) {
        json[scenario.columns[f].name] = moments_json(arm.columns[f]);
        json[scenario.columns[f].name]["unit"] = scenario.columns[f].unit;
    }
    if (!arm.other.empty())
        json["paired_difference"] = {{"pair", arm.name + " - " + arm.other}, {"trace_P", moments_json(arm.difference)}};
    json["seconds_since_commit"] = look.ended() ? Json() : Json(look.seconds_since_commit);
    return json;
}

}  // namespace

std::string watch_text(const Snapshot& look) {
    std::string text = wrapped(printable(look.path) + ": " + state_text(look)) + "\n" + advice(look);
    if (look.scenarios.empty()) return text;
    TextTable table("lr");
    std::vector<std::string> heads{"mean ± 95 % so far"};
    for (const Column& column : look.scenarios.front().columns) heads.push_back(column.name);
    heads.push_back("failed");
    table.row(std::move(heads));
    for (const WatchedScenario& scenario : look.scenarios) add_scenario(table, scenario);
    return text + table.text();
}

std::string watch_json(const Snapshot& look) {
    Json array = Json::array();
    for (const WatchedScenario& scenario : look.scenarios)
        for (const WatchedArm& arm : scenario.arms) array.push_back(arm_json(look, scenario, arm));
    return array.dump(2) + "\n";
}

}  // namespace credence
