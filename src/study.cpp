#include <credence/study.hpp>

#include <credence/chi_square.hpp>
#include <credence/error.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <set>

namespace credence {

namespace {

/// One block to run: which scenario, which block.
struct Task {
    std::size_t scenario = 0;
    std::int64_t block = 0;
};

/// Runs tasks on threads and puts their results into the study. Totals are exact, so the order does not matter.
class Runner {
public:
    Runner(Study& study, const RunOptions& options) : study_(study), options_(options) {
        for (const ScenarioResults& results : study.scenarios)
            problems_.push_back(std::make_unique<Problem>(results.scenario));
    }

    void run() {
        std::vector<Task> tasks;
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s) prepare(s, tasks);
        run_tasks(tasks);
        study_.complete = true;
    }

private:
    /// Takes back a partial last block, makes room, and lists the blocks that are missing.
    void prepare(std::size_t s, std::vector<Task>& tasks) {
        ScenarioResults& results = study_.scenarios[s];
        const std::int64_t had = results.trials;
        if (had >= options_.trials) return;
        const std::int64_t whole_blocks = had / block_size;
        if (had % block_size != 0)
            remove_totals(results, run_block(*problems_[s], study_.root_seed, whole_blocks,
                                             trials_in_block(had, whole_blocks)));
        extend(results, options_.trials);
        for (std::int64_t b = whole_blocks; b < block_count(options_.trials); ++b) tasks.push_back({s, b});
        progress_.total += options_.trials - whole_blocks * block_size;
    }

    void run_tasks(const std::vector<Task>& tasks) {
        const int threads = options_.threads > 0 ? options_.threads : omp_get_max_threads();
        std::exception_ptr trouble;
        std::atomic<bool> stopped = false;
        report();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
        for (std::size_t t = 0; t < tasks.size(); ++t) {
            // An exception must not leave the parallel region (nor an omp critical one): it is kept, and thrown after
            // it.
            if (stopped) continue;
            try {
                run_task(tasks[t]);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                trouble = std::current_exception();
                stopped = true;
            }
        }
        if (trouble) std::rethrow_exception(trouble);
    }

    void run_task(const Task& task) {
        const int trials = trials_in_block(options_.trials, task.block);
        const Block block = run_block(*problems_[task.scenario], study_.root_seed, task.block, trials);
        store_columns(study_.scenarios[task.scenario], block);
        const std::lock_guard lock(mutex_);
        add_totals(study_.scenarios[task.scenario], block);
        progress_.done += trials;
        report();
    }

    void report() {
        progress_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (options_.progress) options_.progress(progress_);
    }

    Study& study_;
    const RunOptions& options_;
    std::vector<std::unique_ptr<Problem>> problems_;
    std::mutex mutex_;  ///< of totals and progress
    Progress progress_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed) {
    Study study{root_seed, {}, false};
    std::set<std::string> names;
    for (const Scenario& scenario : scenarios) {
        if (!names.insert(scenario.name).second)
            throw invalid_value("scenario.name", scenario.name, "two scenarios of the run have it",
                                "Give each its own name");
        study.scenarios.push_back(empty_results(scenario));
    }
    return study;
}

void run_study(Study& study, const RunOptions& options) {
    for (const ScenarioResults& results : study.scenarios)
        if (results.trials > options.trials)
            throw invalid_value(
                "--trials", std::to_string(options.trials),
                "scenario " + results.scenario.name + " has " + std::to_string(results.trials) + " already",
                "Ask for at least as many");
    Runner(study, options).run();
}

Footprint footprint(const Study& study, std::int64_t trials, int threads) {
    Footprint total;
    for (const ScenarioResults& results : study.scenarios) {
        const auto arms = static_cast<std::int64_t>(results.arms.size());
        std::int64_t column_bytes = 8, figures = static_cast<std::int64_t>(results.figures.size());
        for (const Column& column : results.columns)
            column_bytes += column.type == ColumnType::real ? 8 : column.type == ColumnType::integer ? 4 : 1;
        const std::int64_t cells = figures * results.steps();
        const std::int64_t kept = std::min<std::int64_t>(trials, detailed_trials(results.steps(), results.state_size()));
        const std::int64_t detail = kept * results.steps() * (results.state_size() + 1) * 4;
        const std::int64_t shape = shape_counted(results.steps()) ? std::int64_t{results.steps()} * shape_cells * 8 : 0;
        total.file += arms * (trials * column_bytes + cells * 2 * 2 * 8 + (figures + 20) * 1500 + detail + shape);
        const auto in_memory = static_cast<std::int64_t>(results.columns.size() * sizeof(double));
        total.memory += arms * (trials * in_memory + cells * 2 * 64 + 2 * detail + shape);
    }
    total.memory += 2 * total.file + static_cast<std::int64_t>(threads) *
                                         (8 << 20);  // the file's image and the library's, the threads' stacks
    return total;
}

}  // namespace credence
