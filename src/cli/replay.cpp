#include "cli/command.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/detail/store.hpp>
#include <credence/detail/worlds.hpp>
#include <credence/text.hpp>

#include <nlohmann/json.hpp>

#include "base/formatted.hpp"
#include "base/nan.hpp"
#include "base/wording.hpp"
#include "study/releases.hpp"

#include <algorithm>
#include <cmath>

namespace credence::cli {

namespace {

std::vector<Trajectory> replay_noise(const Parsed& parsed, const std::string& record_path) {
    for (const char* option : {"scenario", "arm", "trial"})
        if (parsed.has(option))
            throw InputError(as_option(option) + " does not go with " + as_option("noise"),
                             "a record is one trial, for all arms", "Leave it out");
    check_kind(parsed.arguments.front(), {FileKind::scenario});
    check_kind(record_path, {FileKind::noise});
    const Scenario scenario = read_scenario(parsed.arguments.front(), parsed.overrides());
    return replay_record(scenario, read_noise_record(record_path), record_path);
}

/// What --scenario or --arm gives, or the only one that there is.
std::string given_or_only(const Parsed& parsed, const std::string& option, const std::vector<std::string>& names) {
    if (const std::optional<std::string> value = parsed.text(option)) return *value;
    if (names.size() == 1) return names.front();
    throw InputError("missing " + as_option(option), {}, "It is one of " + joined(names));
}

const ScenarioResults& find_scenario(const Study& study, const Parsed& parsed) {
    std::vector<std::string> names;
    for (const ScenarioResults& results : study.scenarios) names.push_back(results.scenario.name);
    const std::string name = given_or_only(parsed, "scenario", names);
    for (const ScenarioResults& results : study.scenarios)
        if (results.scenario.name == name) return results;
    throw invalid_value(as_option("scenario"), name, "not in the file", "It has " + joined(names));
}

/// The index of the arm that a name denotes: its own name, or that of the only arm of a controller.
std::size_t find_arm(const ScenarioResults& results, const Parsed& parsed) {
    std::vector<std::string> names;
    for (const ArmResults& arm : results.arms) names.push_back(arm.name);
    const std::string name = given_or_only(parsed, "arm", names);
    const std::vector<const ArmResults*> meant = arms_meant(results, name);
    if (meant.size() == 1) return static_cast<std::size_t>(meant.front() - results.arms.data());
    throw invalid_value(as_option("arm"), name,
                        meant.empty() ? "not in the scenario" : "several arms have that controller",
                        "It has " + joined(names));
}

/// The row of the trial in the columns.
std::int64_t row_of(const ScenarioResults& results, std::int64_t trial) {
    const std::optional<std::int64_t> first = first_row(results, trial / block_size);
    if (!first || *first + trial % block_size >= results.trials)
        throw invalid_value(as_option("trial"), std::to_string(trial),
                            "the file is a part of a study and does not have it", "Give one that it has");
    return *first + trial % block_size;
}

/// Equality bit for bit, where any NaN equals any other.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// What to add about a trial that differs where another release computed it, whose draws or columns may differ.
std::string other_release(const Study& study) {
    const std::string other = unmixable(study.computed_by, made_by());
    return other.empty() ? "" : why_unmixable(other, made_by()) + ". Replay it with that release";
}

std::vector<Trajectory> replay_stored(const Parsed& parsed) {
    if (parsed.has("set"))
        throw InputError(as_option("set") + " does not go with a results file", "the trial would be another",
                         "Leave it out");
    check_kind(parsed.arguments.front(), {FileKind::results});
    if (!parsed.has("trial"))
        throw InputError("missing " + as_option("trial"), {},
                         "Give FILE.h5 " + as_option("trial", "I") + ", or SCENARIO.ini " +
                             as_option("noise", "RECORD.h5"));
    const Study study = read_results(parsed.arguments.front(), 0).study;
    const ScenarioResults& results = find_scenario(study, parsed);
    const std::size_t a = find_arm(results, parsed);
    const std::int64_t trial = parsed.integer("trial", 0, 0, study.trials - 1), row = row_of(results, trial);
    Trajectory trajectory = replay_trial(results.scenario, a, study.root_seed, trial);
    for (std::size_t c = 0; c < results.columns.size() && results.keep == Keep::trials; ++c) {
        const auto column = std::ranges::find(trajectory.columns, results.columns[c].name, &Column::name);
        if (column == trajectory.columns.end()) continue;  // an error that a budget keeps
        const double stored = results.arms[a].columns.values(c, row, 1).front(),
                     replayed = trajectory.column_values[static_cast<std::size_t>(column - trajectory.columns.begin())];
        if (!same(stored, replayed))
            throw Failure("the replayed trial differs from " + parsed.arguments.front() + ": " + column->name + " is " +
                              to_text(replayed) + ", stored is " + to_text(stored),
                          {}, other_release(study));
    }
    return {std::move(trajectory)};
}

/// The columns that are printed, by the names that they have in every world, with their label and digits in the text.
struct ShownColumn {
    const char *name, *label;
    int digits;
};
constexpr ShownColumn shown_columns[] = {{"trace_P", "trace(P)", 5},      {"unseen", "unseen", 15},
                                         {"pose_error", "pose error", 5}, {"nees_ratio", "NEES/n", 4},
                                         {"nis_ratio", "NIS/m", 4},       {"log_score", "log score", 4}};

/// The column of that name; nullptr where the world has none.
const Column* find_column(const Trajectory& t, const std::string& name) {
    const auto found = std::ranges::find(t.columns, name, &Column::name);
    return found == t.columns.end() ? nullptr : &*found;
}

Status status_of(const Trajectory& t) {
    return static_cast<Status>(static_cast<int>(t.column_values[status_column(t.columns)]));
}
std::string status_text(const Trajectory& t) { return status_names()[static_cast<std::size_t>(status_of(t))]; }

/// A column's value; NaN where a failed trial has none.
double value_of(const Trajectory& t, const Column& column) {
    if (is_reported(column) && failed(status_of(t))) return nan;
    return t.column_values[static_cast<std::size_t>(&column - t.columns.data())];
}

nlohmann::ordered_json json_of(const Trajectory& t, const Column& column) {
    const double value = value_of(t, column);
    if (column.type != ColumnType::real && !std::isnan(value)) return static_cast<int>(value);
    return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

std::string as_json(const std::vector<Trajectory>& trajectories) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const Trajectory& t : trajectories) {
        nlohmann::ordered_json one{{"scenario", t.scenario.name}, {"arm", t.arm}, {"status", status_text(t)}};
        for (const ShownColumn& shown : shown_columns) {
            const Column* column = find_column(t, shown.name);
            one[shown.name] = column ? json_of(t, *column) : nlohmann::ordered_json();
        }
        for (const Column& column : t.columns)
            if (!one.contains(column.name)) one[column.name] = json_of(t, column);
        array.push_back(one);
    }
    return array.dump(2) + "\n";
}

std::string as_csv(const std::vector<Trajectory>& trajectories) {
    std::string text = "scenario,arm,status";
    for (const ShownColumn& shown : shown_columns) text += std::string(",") + shown.name;
    text += "\n";
    for (const Trajectory& t : trajectories) {
        text += t.scenario.name + "," + t.arm + "," + status_text(t);
        for (const ShownColumn& shown : shown_columns) {
            const Column* column = find_column(t, shown.name);
            const double value = column ? value_of(t, *column) : nan;
            text += "," + (std::isfinite(value) ? to_text(value) : "");
        }
        text += "\n";
    }
    return text;
}

std::string as_text(const std::vector<Trajectory>& trajectories) {
    std::string text;
    for (const Trajectory& t : trajectories) {
        text += t.scenario.name + "/" + t.arm + ": " + status_text(t);
        for (const ShownColumn& shown : shown_columns) {
            const Column* column = find_column(t, shown.name);
            if (column == nullptr) continue;
            const double value = value_of(t, *column);
            text += std::string(", ") + shown.label +
                    (std::isfinite(value) ? formatted(" %.*g", shown.digits, value) : " -");
            if (column->unit != "1" && column == find_column(t, "trace_P")) text += " " + column->unit;
        }
        text += "\n";
    }
    return text;
}

int replay(const Parsed& parsed) {
    if (parsed.arguments.size() != 1)
        throw InputError("replay takes one results file or one scenario", {},
                         as_command({"replay", "--help"}) + " shows how");
    const std::string format = parsed.choice("format");
    const std::optional<std::string> noise = parsed.text("noise");
    const std::optional<Output> output = check_output_option(parsed);
    const std::vector<Trajectory> trajectories = noise ? replay_noise(parsed, *noise) : replay_stored(parsed);
    if (output) {
        RunFacts facts = build_facts();
        facts.emplace_back("command_line", parsed.line);
        write_trajectories(*output, trajectories, facts);
    }
    print(format == "json" ? as_json(trajectories) : format == "csv" ? as_csv(trajectories) : as_text(trajectories));
    return 0;
}

}  // namespace

const Command& replay_command() {
    static const Command command{
        "replay",
        "FILE.h5 [--scenario NAME] [--arm ARM] --trial I | SCENARIO.ini --noise RECORD.h5",
        "run one trial again, pose by pose: from a results file, or on recorded noise",
        "\nFrom a results file the trial is checked against the stored columns bit for bit (exit 1 where it differs); "
        "a\n"
        "file that keeps aggregates has none to check it against.\n"
        "A noise record holds `odometry` [poses, 3], `walk`, `deformation`, `measurement` [poses, features, 2],\n"
        "standardised.\n",
        {{"scenario", "NAME", "scenario of the results file, where it has several"},
         {"arm", "ARM", "arm, where there are several, such as greedy.ekf; greedy alone where that is one arm"},
         {"trial", "I", "trial of the results file, from 0"},
         {"noise", "RECORD.h5", "recorded noise for SCENARIO.ini"},
         set_option(),
         format_option({"text", "json", "csv"}),
         output_option("write the trajectory there: truth, estimates, covariances, innovations, the planner's costs",
                       "FILE.h5"),
         overwrite_option()},
        replay};
    return command;
}

}  // namespace credence::cli
