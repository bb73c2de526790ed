// `credence run --dry-run`: the expected time, memory and file size of a run.

#include "cli/process/limits.hpp"
#include "cli/process/progress.hpp"
#include "cli/run/request.hpp"

#include <credence/error.hpp>
#include <credence/detail/worlds.hpp>

#include "base/wording.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <optional>

namespace credence::cli {

namespace {

/// Seconds that a scenario's blocks take on one thread: those of a block, whatever its trials, and those of each trial.
struct BlockSeconds {
    double block = 0, trial = 0;
};

/// Measured with more and more trials of the last block, for a fifth of a second, or less where there are many
/// scenarios.
BlockSeconds seconds_of_a_block(const Scenario& scenario, const RunRequest& request) {
    constexpr int octet = 8;  // a pack of fewer trials takes as long
    const double enough = std::min(0.1, 5 / static_cast<double>(request.scenarios.size()));
    const BlockRunner runner(world_of(scenario), scenario);
    const std::int64_t last = (request.options.trials - 1) / block_size;
    const auto seconds_of = [&](int trials) {
        const auto start = std::chrono::steady_clock::now();
        runner.run(request.root_seed, last, trials);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    seconds_of(octet);  // the first run touches its memory for the first time
    double before = 0;
    for (int trials = octet;; trials *= 2) {
        const double seconds = seconds_of(trials);
        const bool last_try = trials >= request.options.trials || trials == block_size;
        if (trials > octet && (last_try || seconds > enough)) {
            const double trial = std::max(0.0, seconds - before) / (trials / 2);
            return {std::max(0.0, seconds - trials * trial), trial};
        }
        if (last_try) return {seconds, 0};
        before = seconds;
    }
}

/// Seconds for writing the journal and the results and for reporting them, from scenarios, bytes and cells per second,
/// measured with 1 to 1,000 scenarios of 20 to 20,000 poses (AMD Zen 5, a virtual disk).
double seconds_of_writing(const Footprint& size, std::size_t scenarios) {
    return 0.015 * static_cast<double>(scenarios) + 2 * static_cast<double>(size.file) / 200e6 +
           static_cast<double>(size.cells) * 0.4e-6;
}

Footprint size_of(const RunRequest& request, const Study& study) {
    return footprint(study, request.options.trials / request.options.shard.count, request.options.threads);
}

}  // namespace

void check_fit(const RunRequest& request, const Study& study) {
    if (!request.goals.empty()) return;
    const Footprint size = size_of(request, study);
    const auto refuse = [](const std::string& what, std::int64_t needed, std::int64_t there) {
        throw InputError(
            "cannot run: it takes about " + bytes_text(needed) + " of " + what, bytes_text(there) + " are there",
            "Ask for less, see " + as_option("dry-run") + ", or start it all the same with " + as_option("force"));
    };
    if (const std::int64_t there = memory_limit(); size.memory > there) refuse("memory", size.memory, there);
    std::int64_t missing = 0, all = 0;
    for (const ScenarioResults& results : study.scenarios) {
        missing +=
            trials_in(missing_blocks(results, request.options.trials, request.options.shard), request.options.trials);
        all += std::max<std::int64_t>(1, request.options.trials / request.options.shard.count);
    }
    // The results are written while the journal, which then also holds the missing trials, still exists.
    const double share = std::min(1.0, static_cast<double>(missing) / static_cast<double>(all));
    const auto needed = static_cast<std::int64_t>(static_cast<double>(size.file) * (1 + share));
    if (const std::optional<std::int64_t> there = free_space(request.output); missing > 0 && there && needed > *there)
        refuse("disk", needed, *there);
}

int dry_run(const RunRequest& request, const Study& study) {
    double seconds = 0;
    std::int64_t blocks = 0;
    for (const ScenarioResults& results : study.scenarios) {
        const BlockRanges missing = missing_blocks(results, request.options.trials, request.options.shard);
        blocks += missing.count();
        const BlockSeconds of_block = seconds_of_a_block(results.scenario, request);
        seconds += of_block.block * static_cast<double>(missing.count()) +
                   of_block.trial * static_cast<double>(trials_in(missing, request.options.trials));
    }
    const std::int64_t at_once = std::min(
        {std::int64_t{request.options.threads}, std::int64_t{omp_get_num_procs()}, std::max<std::int64_t>(1, blocks)});
    const Footprint size = size_of(request, study);
    seconds = seconds / static_cast<double>(at_once) + seconds_of_writing(size, study.scenarios.size());
    print("scenarios: " + std::to_string(request.scenarios.size()) + ", trials of each: " +
          std::to_string(request.options.trials) + ", threads: " + std::to_string(request.options.threads) + ".\n" +
          wrapped("About " + duration_text(seconds) + ", " + bytes_text(size.memory) +
                  " of memory, " + bytes_text(size.file) + " in " + printable(request.output) +
                  (request.keep == Keep::trials ? ", as much again in its journal meanwhile"
                                                : ", as much in its journal at every commit")) +
          (request.goals.empty() ? "\n" : ":\nthe cost of the ceiling, --until may stop sooner\n"));
    return 0;
}

}  // namespace credence::cli
