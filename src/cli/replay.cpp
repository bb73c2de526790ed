#include "cli/command.hpp"
#include "cli/file_kind.hpp"
#include "cli/version.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/deformable.hpp"
#include <credence/store.hpp>
#include <credence/text.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace credence::cli {

const Command& replay_command() {
    static const Command command{
        "replay",
        "FILE.h5 --scenario NAME --arm ARM --trial I | SCENARIO.ini --noise RECORD.h5",
        "run one trial again, pose by pose: from a results file, or on recorded noise",
        "\nFrom a results file the trial is checked against the stored columns bit for bit (exit 1 where it differs); a\n"
        "file that keeps aggregates has none to check it against.\n"
        "A noise record holds `odometry` [poses, 3], `walk`, `deformation`, `measurement` [poses, features, 2],\n"
        "standardised.\n",
        {{"scenario", "NAME", "scenario of the results file"},
         {"arm", "ARM", "arm of the results file, such as greedy.ekf; greedy alone where that is one arm"},
         {"trial", "I", "trial of the results file, from 0"},
         {"noise", "RECORD.h5", "recorded noise for SCENARIO.ini"},
         set_option(),
         format_option({"text", "json", "csv"}),
         output_option("write the trajectory there: truth, estimates, covariances, innovations, the planner's costs",
                       "FILE.h5"),
         overwrite_option()}};
    return command;
}

namespace {

std::vector<Trajectory> replay_noise(const Parsed& parsed, const std::string& record_path) {
    for (const char* option : {"scenario", "arm", "trial"})
        if (parsed.has(option))
            throw InputError(std::string("--") + option +
                             " does not go with --noise (a record is one trial, for all arms). Leave it out.");
    check_kind(parsed.arguments.front(), {FileKind::scenario});
    check_kind(record_path, {FileKind::noise});
    const DeformableSettings scenario = read_deformable(parsed.arguments.front(), parsed.overrides());
    const NoiseRecord record = read_noise_record(record_path);
    check_covers(record, scenario, record_path);
    const Problem problem(scenario);
    std::vector<Trajectory> trajectories;
    for (const Arm& arm : arms_of(scenario)) trajectories.push_back(replay_record(problem, arm, record));
    return trajectories;
}

std::string needed(const Parsed& parsed, const std::string& option) {
    const std::optional<std::string> value = parsed.text(option);
    if (!value)
        throw InputError("missing --" + option +
                         ". Give FILE.h5 --scenario NAME --arm ARM --trial I, or SCENARIO.ini --noise RECORD.h5.");
    return *value;
}

const ScenarioResults& find_scenario(const Study& study, const std::string& name) {
    std::vector<std::string> names;
    for (const ScenarioResults& results : study.scenarios) {
        if (results.scenario.name == name) return results;
        names.push_back(results.scenario.name);
    }
    throw invalid_value("--scenario", name, "not in the file", "It has " + joined(names));
}

/// The index of the arm that a name denotes: its own name, or that of the only arm of a controller.
std::size_t find_arm(const ScenarioResults& results, const std::string& name) {
    const std::vector<const ArmResults*> meant = arms_meant(results, name);
    if (meant.size() == 1) return static_cast<std::size_t>(meant.front() - results.arms.data());
    std::vector<std::string> names;
    for (const ArmResults& arm : results.arms) names.push_back(arm.name);
    throw invalid_value("--arm", name, meant.empty() ? "not in the scenario" : "several arms have that controller",
                        "It has " + joined(names));
}

/// The row of the trial in the columns.
std::int64_t row_of(const ScenarioResults& results, std::int64_t trial) {
    const std::optional<std::int64_t> first = first_row(results, trial / block_size);
    if (!first || *first + trial % block_size >= results.trials)
        throw invalid_value("--trial", std::to_string(trial), "the file is a part of a study and does not have it",
                            "Give one that it has");
    return *first + trial % block_size;
}

/// Equality bit for bit, where any NaN equals any other.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

std::vector<Trajectory> replay_stored(const Parsed& parsed) {
    if (parsed.has("set"))
        throw InputError("--set does not go with a results file (the trial would be another). Leave it out.");
    check_kind(parsed.arguments.front(), {FileKind::results});
    const std::string scenario_name = needed(parsed, "scenario"), arm = needed(parsed, "arm");
    needed(parsed, "trial");
    const Study study = read_results(parsed.arguments.front(), 0).study;
    const ScenarioResults& results = find_scenario(study, scenario_name);
    const std::size_t a = find_arm(results, arm);
    const std::int64_t trial = parsed.integer("trial", 0, 0, study.trials - 1), row = row_of(results, trial);
    const Problem problem(settings_of(results.scenario));
    Trajectory trajectory = replay_trial(problem, arms_of(problem.scenario())[a], study.root_seed, trial);
    for (std::size_t c = 0; c < results.columns.size() && results.keep == Keep::trials; ++c) {
        const double stored = column_values(results.arms[a], c, row, 1).front();
        if (!same(stored, trajectory.columns[c]))
            throw Failure("the replayed trial differs from " + parsed.arguments.front() + ": " +
                          results.columns[c].name + " is " + to_text(trajectory.columns[c]) + ", stored is " +
                          to_text(stored) + ".");
    }
    return {std::move(trajectory)};
}

std::string status_text(const Trajectory& t) {
    return status_names()[static_cast<std::size_t>(t.columns[column_status])];
}

std::string as_json(const std::vector<Trajectory>& trajectories) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const Trajectory& t : trajectories) {
        const bool missing = failed(static_cast<Status>(static_cast<int>(t.columns[column_status])));
        nlohmann::ordered_json one{{"scenario", t.scenario.name},
                                   {"arm", arm_name(t.arm)},
                                   {"status", status_text(t)},
                                   {"trace_P", t.columns[column_trace_P]},
                                   {"unseen", nullptr},
                                   {"pose_error", t.columns[column_pose_error]},
                                   {"nees_ratio", t.columns[column_nees_ratio]},
                                   {"nis_ratio", t.columns[column_nis_ratio]},
                                   {"status_pose", static_cast<int>(t.columns[column_status_pose])}};
        if (!missing) one["unseen"] = static_cast<int>(t.columns[column_unseen]);
        array.push_back(one);
    }
    return array.dump(2) + "\n";
}

std::string as_csv(const std::vector<Trajectory>& trajectories) {
    std::string text = "scenario,arm,status,trace_P,unseen,pose_error,nees_ratio,nis_ratio\n";
    for (const Trajectory& t : trajectories) {
        text += t.scenario.name + "," + arm_name(t.arm) + "," + status_text(t);
        for (int c = column_trace_P; c <= column_nis_ratio; ++c)
            text += "," + (std::isfinite(t.columns[static_cast<std::size_t>(c)])
                               ? to_text(t.columns[static_cast<std::size_t>(c)])
                               : "");
        text += "\n";
    }
    return text;
}

/// A value as text; `-` for one that a failed trial does not have.
std::string figure_text(double value, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return std::isfinite(value) ? text : "-";
}

std::string as_text(const std::vector<Trajectory>& trajectories) {
    std::string text;
    for (const Trajectory& t : trajectories) {
        const auto figure = [&](ColumnIndex column, int digits) { return figure_text(t.columns[column], digits); };
        const bool unseen_known = t.columns[column_unseen] >= 0;
        text += t.scenario.name + "/" + arm_name(t.arm) + ": " + status_text(t) + ", trace(P) " +
                figure(column_trace_P, 5) + " " + trace_unit(t.scenario) + ", unseen " +
                (unseen_known ? figure(column_unseen, 15) : "-") + ", pose error " + figure(column_pose_error, 5) +
                ", NEES/n " + figure(column_nees_ratio, 4) + ", NIS/m " + figure(column_nis_ratio, 4) + "\n";
    }
    return text;
}

}  // namespace

int replay(const Parsed& parsed, const std::string& command_line) {
    if (parsed.arguments.size() != 1)
        throw InputError("replay takes one results file or one scenario. `credence replay --help` shows how.");
    const std::string format = parsed.choice("format");
    const std::optional<std::string> noise = parsed.text("noise");
    const std::optional<Output> output = check_output_option(parsed);
    const std::vector<Trajectory> trajectories = noise ? replay_noise(parsed, *noise) : replay_stored(parsed);
    if (output) {
        RunFacts facts = build_facts();
        facts.emplace_back("command_line", command_line);
        write_trajectories(*output, trajectories, facts);
    }
    print(format == "json"  ? as_json(trajectories)
          : format == "csv" ? as_csv(trajectories)
                            : as_text(trajectories));
    return 0;
}

}  // namespace credence::cli
