#include "cli/run/request.hpp"

#include "cli/run/launcher.hpp"
#include "files/system/durable_file.hpp"
#include "study/budget.hpp"
#include "base/wording.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <omp.h>

namespace credence::cli {

namespace {

constexpr std::int64_t default_trials = 10000, default_ceiling = 10'000'000;

/// `part-{shard}.h5`: a different name for every shard of one command line.
std::string output_of(const Parsed& parsed, const Shard& shard) {
    std::string name = parsed.text("output").value_or("credence.h5");
    const std::string place = "{shard}";
    const std::size_t at = name.find(place);
    if (at == std::string::npos) return name;
    if (!parsed.has("shard"))
        throw invalid_value("-o", name, "there is no --shard that {shard} could stand for",
                            "Give --shard, or another name");
    return name.replace(at, place.size(), std::to_string(shard.index));
}

Shard shard_of(const Parsed& parsed) {
    const std::optional<std::string> text = parsed.text("shard");
    if (!text) return {};
    return *text == "auto" ? shard_of_launcher(environment()) : parse_shard(*text);
}

Start start_of(const Parsed& parsed) {
    if (parsed.has("resume") && parsed.has("overwrite"))
        throw InputError("--resume and --overwrite contradict each other", {}, "Give one of them");
    return parsed.has("resume") ? Start::resume : parsed.has("overwrite") ? Start::overwrite : Start::fresh;
}

/// Takes the study from the file that is resumed.
void take_stored(const Parsed& parsed, RunRequest& request) {
    for (const char* option : {"set", "sweep", "seed", "keep", "budget"})
        if (parsed.has(option))
            throw InputError(as_option(option) + " needs a scenario",
                             "without one, the study in the file is resumed as it is",
                             "Name one or more SCENARIO.ini, or leave it out");
    StudyDefinition stored = stored_definition(request.output);
    request.scenarios = std::move(stored.scenarios);
    request.root_seed = stored.root_seed;
    request.keep = stored.keep;
}

}  // namespace

std::vector<Scenario> scenarios_of(const Parsed& parsed, std::optional<KeptErrors> kept) {
    for (const std::string& path : parsed.arguments) check_kind(path, {FileKind::scenario});
    const std::vector<SweepAxis> axes = parsed.sweep();
    const std::size_t count = parsed.arguments.size() * point_count(axes);
    if (!axes.empty() && count > most_swept_scenarios)
        throw invalid_value(as_option("sweep"), joined(parsed.values.at("sweep")),
                            "so many points of so many files are " + std::to_string(count) + " scenarios",
                            "Give at most " + std::to_string(most_swept_scenarios) + " in one study");
    std::vector<Scenario> scenarios;
    for (const std::string& path : parsed.arguments)
        for (Scenario& one : read_grid(path, parsed.overrides(), axes)) {
            if (!kept) scenarios.push_back(std::move(one));
            else
                for (Scenario& world : budget_scenarios(one, *kept)) scenarios.push_back(std::move(world));
        }
    return scenarios;
}

std::optional<KeptErrors> kept_errors(const Parsed& parsed, const std::string& option) {
    if (!parsed.has(option)) return std::nullopt;
    return parsed.choice(option) == "mean" ? KeptErrors::mean : KeptErrors::last;
}

RunRequest read_request(const Parsed& parsed) {
    const bool is_stored = parsed.arguments.empty() && parsed.has("resume");
    if (parsed.arguments.empty() && !is_stored)
        throw InputError("no scenario given", {}, "Name one or more SCENARIO.ini, or resume with --resume -o FILE.h5");
    RunRequest request;
    request.options.shard = shard_of(parsed);
    request.output = output_of(parsed, request.options.shard);
    check_not_read(Output(request.output), parsed.arguments);
    if (const auto until = parsed.values.find("until"); until != parsed.values.end())
        for (const std::string& goal : until->second) request.goals.push_back(parse_goal(goal));
    request.options.trials =
        parsed.integer("trials", request.goals.empty() ? default_trials : default_ceiling, 1, most_trials);
    request.root_seed = parsed.seed(request.root_seed);
    request.options.threads = static_cast<int>(parsed.integer("threads", omp_get_max_threads(), 1, 4096));
    request.trials_given = parsed.has("trials");
    request.start = start_of(parsed);
    request.quiet = parsed.has("quiet");
    request.keep = parsed.choice("keep") == keep_name(Keep::aggregates) ? Keep::aggregates : Keep::trials;
    request.commit_every = parsed.integer("commit-every", 0, 1, most_trials);
    if (request.options.shard.count > 1 && !request.goals.empty())
        throw InputError("--until and --shard contradict each other", "a shard cannot tell what all of them have",
                         "Give one of them");
    if (is_stored) take_stored(parsed, request);
    else request.scenarios = scenarios_of(parsed, kept_errors(parsed, "budget"));
    return request;
}

StoredRun starting_run(RunRequest& request) {
    Study study = new_study(request.scenarios, request.root_seed, request.keep);
    check_goals(request.goals, study);
    StoredRun run(request.output, std::move(study), request.start, made_by());
    const std::int64_t before = least_trials(run.study());
    if (!request.trials_given && request.goals.empty() && before > 0) request.options.trials = before;
    return run;
}

}  // namespace credence::cli
