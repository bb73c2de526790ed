#include "progress.hpp"
#include "run_until.hpp"
#include "version.hpp"

#include <credence/report.hpp>
#include <credence/store.hpp>
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
         {"until", "METRIC=HALFWIDTH",
          "stop at the first look (4096 trials, 8192 ...) at which this mean is known to +- HALFWIDTH, such as "
          "trace_P=0.5% or 'trace_P[greedy-fixed]=0.01'; --trials is the ceiling then (default 10^7); repeatable: "
          "all must be met",
          true},
         {"resume", "",
          "run what is missing in the results file, also to a larger --trials; start where there is none"},
         {"overwrite", "", "replace a results file that exists"},
         {"dry-run", "", "say what time, memory and file size to expect, and stop"},
         {"quiet", "", "no progress and no table"}}};
    return command;
}

namespace {

bool nothing_missing(const Study& study, std::int64_t trials) {
    for (const ScenarioResults& results : study.scenarios)
        if (results.trials < trials) return false;
    return study.complete;
}

/// Of all scenarios together.
std::int64_t trials_of(const Study& study) {
    std::int64_t trials = 0;
    for (const ScenarioResults& results : study.scenarios) trials += results.trials;
    return trials;
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
              << " of memory, " << bytes_text(size.file) << " in " << request.output
              << (request.goals.empty() ? "" : ": the cost of the ceiling, --until may stop sooner") << "\n";
    return 0;
}

/// What a run did to its study.
struct Work {
    bool changed = true;
    double seconds = 0;
    std::optional<Look> last_look;  ///< with --until
};

/// Runs what is missing of what was asked for.
Work work_on(Study& study, const RunRequest& request) {
    const bool was_complete = study.complete;
    const std::int64_t had = trials_of(study);
    const auto start = std::chrono::steady_clock::now();
    Work work;
    if (!request.goals.empty()) {
        work.last_look = grow_until_precise(study, request);
    } else if (!nothing_missing(study, request.options.trials)) {
        RunOptions options = request.options;
        ProgressLine progress(request.quiet);
        options.progress = [&](const Progress& now) { progress(now); };
        run_study(study, options);
        progress.finish();
    }
    work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    work.changed = !was_complete || trials_of(study) != had;
    return work;
}

void print_table(const Study& study, const RunRequest& request, const Work& work) {
    std::cout << report_text(make_report(study, 0.05)) << "\n";
    if (work.last_look) std::cout << stopping_text(*work.last_look);
    std::cout << request.output;
    if (work.changed)
        std::cout << ": " << bytes_text(static_cast<std::int64_t>(std::filesystem::file_size(request.output)))
                  << ", computed in " << duration_text(work.seconds) << " on " << request.options.threads
                  << " threads\n";
    else
        std::cout << " has these trials already\n";
}

}  // namespace

int run(const Parsed& parsed, const std::string& command_line) {
    const RunRequest request = read_request(parsed);
    Study study = starting_study(request);
    if (parsed.has("dry-run")) return dry_run(request, study);

    RunFacts facts = build_facts();
    facts.emplace_back("started", now_text());
    const Work work = work_on(study, request);
    if (work.changed) {
        facts.emplace_back("threads", std::to_string(request.options.threads));
        facts.emplace_back("wall_seconds", to_text(work.seconds));
        facts.emplace_back("command_line", command_line);
        write_results(request.output, study, facts);
    }
    if (work.last_look && !work.last_look->met)
        std::cerr << "credence run: " << imprecision_text(*work.last_look, request.rule()) << "\n";
    if (!request.quiet) print_table(study, request, work);
    return 0;
}

}  // namespace credence::cli
