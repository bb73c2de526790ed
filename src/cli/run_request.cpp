#include "run_request.hpp"

#include <credence/error.hpp>
#include <credence/scenario_keys.hpp>
#include <credence/store.hpp>

#include <omp.h>

#include <filesystem>
#include <limits>

namespace credence::cli {

namespace {

constexpr std::int64_t default_trials = 10000, default_ceiling = 10'000'000;

/// Refuses to go on with another study, saying what differs.
void check_same_study(const Study& stored, const Study& asked, const std::string& path) {
    if (study_hash(stored) == study_hash(asked)) return;
    std::string why = "it has other scenarios";
    if (stored.root_seed != asked.root_seed)
        why = "its root seed is " + std::to_string(stored.root_seed) + ", not " + std::to_string(asked.root_seed);
    else if (stored.scenarios.size() != asked.scenarios.size())
        why = "it has " + std::to_string(stored.scenarios.size()) + " scenarios, not " +
              std::to_string(asked.scenarios.size());
    else
        for (std::size_t s = 0; s < stored.scenarios.size(); ++s) {
            const std::vector<KeyDifference> differences =
                key_differences(stored.scenarios[s].scenario, asked.scenarios[s].scenario);
            if (differences.empty()) continue;
            const KeyDifference& first = differences.front();
            why = "scenario " + stored.scenarios[s].scenario.name + ": " + first.key + " is " + first.a +
                  " there and " + first.b + " here";
            break;
        }
    throw InputError("cannot resume " + path + " (it holds another study: " + why + "). Name another output.");
}

}  // namespace

RunRequest read_request(const Parsed& parsed) {
    if (parsed.arguments.empty()) throw InputError("no scenario given. Name one or more SCENARIO.ini.");
    RunRequest request;
    request.output = parsed.text("output").value_or("credence.h5");
    if (const auto until = parsed.values.find("until"); until != parsed.values.end())
        for (const std::string& goal : until->second) request.goals.push_back(parse_goal(goal));
    request.options.trials =
        parsed.integer("trials", request.goals.empty() ? default_trials : default_ceiling, 1, 1'000'000'000'000);
    request.root_seed =
        static_cast<std::uint64_t>(parsed.integer("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
    request.options.threads = static_cast<int>(parsed.integer("threads", omp_get_max_threads(), 1, 4096));
    request.resume = parsed.has("resume");
    request.overwrite = parsed.has("overwrite");
    request.quiet = parsed.has("quiet");
    if (request.resume && request.overwrite)
        throw InputError("--resume and --overwrite contradict each other. Give one of them.");
    for (const std::string& path : parsed.arguments)
        request.scenarios.push_back(read_scenario(path, parsed.overrides()));
    return request;
}

Study starting_study(const RunRequest& request) {
    Study study = new_study(request.scenarios, request.root_seed);
    check_goals(request.goals, study);
    check_output(request.output, request.overwrite || request.resume, "Give another name, --resume or --overwrite");
    std::error_code none;
    if (request.resume && std::filesystem::exists(request.output, none)) {
        Study stored = read_results(request.output).study;
        check_same_study(stored, study, request.output);
        study = std::move(stored);
    }
    return study;
}

}  // namespace credence::cli
