// A snapshot of a run, as text and as JSON.

#include "report/watch/watch.hpp"

#include <credence/error.hpp>

#include "base/wording.hpp"
#include "report/format.hpp"
#include "report/table.hpp"
#include "report/data/json.hpp"

#include <algorithm>

namespace credence {

namespace {

std::string of_text(std::int64_t done, std::int64_t asked) {
    return std::to_string(done) + (done == asked ? "" : " of " + std::to_string(asked));
}

std::string shard_text(const Snapshot& snapshot) {
    if (snapshot.shard.count == 1) return "";
    return ", shard " + std::to_string(snapshot.shard.index) + "/" + std::to_string(snapshot.shard.count) + " of " +
           std::to_string(snapshot.trials) + " trials a scenario";
}

/// The state of the run.
std::string state_text(const Snapshot& snapshot) {
    const std::string trials = of_text(snapshot.trials_done(), snapshot.trials_asked()) + " trials";
    switch (snapshot.state) {
        case RunState::begun: return "begun, nothing committed yet";
        case RunState::complete: return "complete, " + trials;
        case RunState::incomplete:
            return (snapshot.shard.count > 1 ? "a whole part, " + trials : "not all there, " + trials) +
                   shard_text(snapshot);
        case RunState::running: break;
    }
    const double share = 100 * static_cast<double>(snapshot.trials_done()) /
                         static_cast<double>(std::max<std::int64_t>(1, snapshot.trials_asked()));
    std::string text = "running, " + trials + " (" + number(share, 0) + " %)" + shard_text(snapshot);
    if (snapshot.trials_per_second) text += "; " + number(*snapshot.trials_per_second, 0) + " trials/s";
    if (const std::optional<double> left = snapshot.time_left()) text += ", " + duration_text(*left) + " left";
    return text + "; last commit " + duration_text(snapshot.seconds_since_commit) + " ago";
}

/// Advice where the run may have ended without finishing.
std::string advice(const Snapshot& snapshot) {
    constexpr double long_time = 60;
    if (snapshot.state == RunState::incomplete && snapshot.shard.count == 1)
        return "A run that was stopped is resumed by --resume; parts are joined by `" + program_name() + " merge`.\n";
    if (snapshot.ended() || snapshot.seconds_since_commit < long_time) return "";
    return std::string(snapshot.trials_done() < snapshot.trials_asked() ? "Nothing has been committed for a while"
                                                                : "All is committed, and the results file is due") +
           ". If the run is dead, the same command with --resume resumes it.\n";
}

std::string units_text(const WatchedScenario& scenario) {
    std::string text;
    for (const Column& column : scenario.columns)
        if (!column.unit.empty() && column.unit != "1") text += ", " + column.name + " [" + column.unit + "]";
    return text;
}

Cell mean_cell_of(const Moments& moments) {
    return moments.count > 0 ? mean_cell(moments.mean, t_interval(moments)) : Cell("-");
}

void add_scenario(Table& table, const WatchedScenario& scenario) {
    if (scenario.trials == 0) {
        table.group(
            wrapped(scenario.name + ": not run yet, " + std::to_string(scenario.trials_asked) + " trials asked for"));
        return;
    }
    table.group(wrapped(scenario.name + ": " + of_text(scenario.trials, scenario.trials_asked) + " trials, " +
                        of_text(scenario.blocks, scenario.blocks_asked) + " blocks" + units_text(scenario)));
    for (const WatchedArm& arm : scenario.arms) {
        std::vector<Cell> cells;
        for (const Moments& column : arm.columns) cells.push_back(mean_cell_of(column));
        cells.push_back(count_cell(static_cast<double>(arm.failed + arm.diverged)));
        table.row("  " + arm.name, std::move(cells));
    }
    for (const WatchedArm& arm : scenario.arms)
        if (!arm.other.empty()) table.row("  " + arm.name + " - " + arm.other, {mean_cell_of(arm.difference)});
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

Json arm_json(const Snapshot& snapshot, const WatchedScenario& scenario, const WatchedArm& arm) {
    Json json{{"scenario", scenario.name},
              {"arm", arm.name},
              {"state", state_name(snapshot.state)},
              {"trials", scenario.trials},
              {"trials_asked", scenario.trials_asked},
              {"blocks", scenario.blocks},
              {"blocks_asked", scenario.blocks_asked},
              {"failed", arm.failed},
              {"diverged", arm.diverged},
              {"failed_trials", arm.failed + arm.diverged}};
    for (std::size_t f = 0; f < arm.columns.size(); ++f) {
        json[scenario.columns[f].name] = moments_json(arm.columns[f]);
        json[scenario.columns[f].name]["unit"] = scenario.columns[f].unit;
    }
    if (!arm.other.empty())
        json["paired_difference"] = {{"pair", arm.name + " - " + arm.other}, {"trace_P", moments_json(arm.difference)}};
    json["seconds_since_commit"] = snapshot.ended() ? Json() : Json(snapshot.seconds_since_commit);
    return json;
}

}  // namespace

std::string watch_text(const Snapshot& snapshot) {
    std::string text = wrapped(printable(snapshot.path) + ": " + state_text(snapshot)) + "\n" + advice(snapshot);
    if (snapshot.scenarios.empty()) return text;
    std::vector<std::string> heads{"mean ± 95 % so far"};
    for (const Column& column : snapshot.scenarios.front().columns) heads.push_back(column.name);
    heads.push_back("failed");
    Table table("", std::move(heads));
    for (const WatchedScenario& scenario : snapshot.scenarios) add_scenario(table, scenario);
    return text + table_text(table, 0);
}

std::string watch_json(const Snapshot& snapshot) {
    Json array = Json::array();
    for (const WatchedScenario& scenario : snapshot.scenarios)
        for (const WatchedArm& arm : scenario.arms) array.push_back(arm_json(snapshot, scenario, arm));
    return array.dump(2) + "\n";
}

}  // namespace credence
