#include "run_dry.hpp"

#include "progress.hpp"

#include <credence/error.hpp>

#include <omp.h>

#include <algorithm>
#include <chrono>

namespace credence::cli {

std::string threads_text(const RunRequest& request) {
    return (request.ranks > 1 ? std::to_string(request.ranks) + " x " : "") + std::to_string(request.options.threads);
}

namespace {

/// Seconds that one trial of a scenario takes on one thread: tried with more and more of them, for a fifth of a second,
/// or less where there are many scenarios.
double seconds_of_a_trial(const Declaration& scenario, const RunRequest& request) {
    const double enough = std::min(0.1, 5 / static_cast<double>(request.scenarios.size()));
    const BlockRunner runner(scenario);
    for (int trials = 1;; trials *= 2) {
        const auto start = std::chrono::steady_clock::now();
        runner.run(request.root_seed, 0, trials);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (seconds > enough || trials == block_size || trials >= request.options.trials) return seconds / trials;
    }
}

}  // namespace

int dry_run(const RunRequest& request, const Study& study) {
    double seconds = 0;
    std::int64_t blocks = 0;
    for (const ScenarioResults& results : study.scenarios) {
        const BlockRanges missing = missing_blocks(results, request.options.trials, request.options.shard);
        blocks += missing.count();
        seconds += seconds_of_a_trial(results.scenario, request) *
                   static_cast<double>(trials_in(missing, request.options.trials));
    }
    const std::int64_t of_a_rank = std::min<std::int64_t>(request.options.threads, omp_get_num_procs()),
                       at_once = std::min(of_a_rank * request.ranks, std::max<std::int64_t>(1, blocks));
    const Footprint size =
        footprint(study, request.options.trials / request.options.shard.count, request.options.threads);
    print("scenarios: " + std::to_string(request.scenarios.size()) + ", trials of each: " +
          std::to_string(request.options.trials) + ", threads: " + threads_text(request) + ".\n" +
          wrapped("About " + duration_text(seconds / static_cast<double>(at_once)) + ", " + bytes_text(size.memory) +
                  " of memory, " + bytes_text(size.file) + " in " + printable(request.output) +
                  (request.keep == Keep::trials ? ", as much again in its journal meanwhile"
                                                : ", as much in its journal at every commit")) +
          (request.goals.empty() ? "\n" : ":\nthe cost of the ceiling, --until may stop sooner\n"));
    return 0;
}

}  // namespace credence::cli
