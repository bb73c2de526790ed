#include "command.hpp"
#include "progress.hpp"
#include "version.hpp"

#include <credence/error.hpp>
#include <credence/report.hpp>
#include <credence/scenario_keys.hpp>
#include <credence/text.hpp>

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>

namespace credence::cli {

const Command& run_command() {
    static const Command command{
        "run",
        "SCENARIO.ini... [options]",
        "run a study: every scenario under all its arms",
        "\nThe same scenarios and seed give the same results for any number of threads.\n",
        {output_option("results file (default credence.h5)"),
         {"trials", "N", "trials of each scenario (default 10000)"},
         {"seed", "N", "root seed, from 0 up (default 1)"},
         {"threads", "N", "threads (default: all processors)"},
         set_option(),
         {"resume", "",
          "run what is missing in the results file, also to a larger --trials; start where there is none"},
         {"overwrite", "", "replace a results file that exists"},
         {"dry-run", "", "say what time, memory and file size to expect, and stop"},
         {"quiet", "", "no progress and no table"}}};
    return command;
}

namespace {

struct RunRequest {
    std::vector<Scenario> scenarios;
    std::string output;
    std::uint64_t root_seed = 1;
    RunOptions options;
    bool resume = false, overwrite = false, quiet = false;
};

RunRequest read_request(const Parsed& parsed) {
    if (parsed.arguments.empty()) throw InputError("no scenario given. Name one or more SCENARIO.ini.");
    RunRequest request;
    request.output = parsed.text("output").value_or("credence.h5");
    request.options.trials = parsed.integer("trials", 10000, 1, 1'000'000'000'000);
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

/// The first key in which two resolved scenarios differ, with both values.
std::string first_difference(const Scenario& stored, const Scenario& asked) {
    for (const ScenarioKey& key : scenario_keys())
        if (key.get(stored) != key.get(asked))
            return key.name + " is " + key.get(stored) + " there and " + key.get(asked) + " here";
    return "";
}

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
            const std::string difference = first_difference(stored.scenarios[s].scenario, asked.scenarios[s].scenario);
            if (!difference.empty()) {
                why = "scenario " + stored.scenarios[s].scenario.name + ": " + difference;
                break;
            }
        }
    throw InputError("cannot resume " + path + " (it holds another study: " + why + "). Name another output.");
}

/// The study to go on with: new, or what the results file holds.
Study starting_study(const RunRequest& request) {
    Study study = new_study(request.scenarios, request.root_seed);
    check_output(request.output, request.overwrite || request.resume, "Give another name, --resume or --overwrite");
    std::error_code none;
    if (request.resume && std::filesystem::exists(request.output, none)) {
        Study stored = read_results(request.output).study;
        check_same_study(stored, study, request.output);
        study = std::move(stored);
    }
    return study;
}

bool nothing_missing(const Study& study, std::int64_t trials) {
    for (const ScenarioResults& results : study.scenarios)
        if (results.trials < trials) return false;
    return study.complete;
}

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

/// Seconds that one trial of a scenario takes on one thread: tried with more and more of them, for a fifth of a second.
double seconds_of_a_trial(const Scenario& scenario, const RunRequest& request) {
    const Problem problem(scenario);
    for (int trials = 1;; trials *= 2) {
        const auto start = std::chrono::steady_clock::now();
        run_block(problem, request.root_seed, 0, trials);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (seconds > 0.1 || trials == block_size || trials >= request.options.trials) return seconds / trials;
    }
}

int dry_run(const RunRequest& request, const Study& study) {
    double seconds = 0;
    std::int64_t blocks = 0;
    for (const ScenarioResults& results : study.scenarios) {
        const std::int64_t missing = std::max<std::int64_t>(0, request.options.trials - results.trials);
        seconds += seconds_of_a_trial(results.scenario, request) * static_cast<double>(missing);
        blocks += block_count(missing);
    }
    const std::int64_t at_once =
        std::min<std::int64_t>({request.options.threads, omp_get_num_procs(), std::max<std::int64_t>(1, blocks)});
    const Footprint size = footprint(study, request.options.trials, request.options.threads);
    std::cout << "scenarios: " << request.scenarios.size() << ", trials of each: " << request.options.trials
              << ", threads: " << request.options.threads << ". About "
              << duration_text(seconds / static_cast<double>(at_once)) << ", " << bytes_text(size.memory)
              << " of memory, " << bytes_text(size.file) << " in " << request.output << "\n";
    return 0;
}

}  // namespace

int run(const Parsed& parsed, const std::string& command_line) {
    const RunRequest request = read_request(parsed);
    Study study = starting_study(request);
    if (parsed.has("dry-run")) return dry_run(request, study);
    if (nothing_missing(study, request.options.trials)) {
        if (!request.quiet)
            std::cout << report_text(make_report(study, 0.05)) << "\n"
                      << request.output << " has these trials already\n";
        return 0;
    }

    RunFacts facts = build_facts();
    facts.emplace_back("started", now_text());
    RunOptions options = request.options;
    ProgressLine progress(request.quiet);
    options.progress = [&](const Progress& now) { progress(now); };
    const auto start = std::chrono::steady_clock::now();
    run_study(study, options);
    progress.finish();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    facts.emplace_back("threads", std::to_string(options.threads));
    facts.emplace_back("wall_seconds", to_text(seconds));
    facts.emplace_back("command_line", command_line);
    write_results(request.output, study, facts);

    if (!request.quiet) {
        std::cout << report_text(make_report(study, 0.05)) << "\n"
                  << request.output << ": "
                  << bytes_text(static_cast<std::int64_t>(std::filesystem::file_size(request.output)))
                  << ", computed in " << duration_text(seconds) << " on " << options.threads << " threads\n";
    }
    return 0;
}

}  // namespace credence::cli
