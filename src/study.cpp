#include <credence/study.hpp>

#include <credence/error.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <iterator>
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

/// Whether the last block that is there would be larger in a study of `trials` trials.
bool last_would_grow(const ScenarioResults& results, std::int64_t trials) {
    return !results.blocks.empty() &&
           block_rows(results, results.blocks.size() - 1) < trials_in_block(trials, results.blocks.back());
}

/// Runs tasks on threads and puts their results into the study. Totals are exact, so the order does not matter.
class Runner {
public:
    Runner(Study& study, const RunOptions& options) : study_(study), options_(options), done_(study.scenarios.size()) {
        for (const ScenarioResults& results : study.scenarios)
            problems_.push_back(std::make_unique<Problem>(results.scenario));
    }

    void run() {
        std::vector<Task> tasks;
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s) prepare(s, tasks);
        study_.trials = options_.trials;
        run_tasks(tasks);
        if (progress_.done < progress_.total) leave_out_missing();
        study_.complete = true;
        for (const ScenarioResults& results : study_.scenarios)
            study_.complete = study_.complete && missing_blocks(results, study_.trials).empty();
        if (options_.keeper != nullptr) options_.keeper->finished(study_);
    }

private:
    /// Takes back a partial last block that will be larger, makes room, and lists the blocks that are missing.
    void prepare(std::size_t s, std::vector<Task>& tasks) {
        ScenarioResults& results = study_.scenarios[s];
        const std::vector<std::int64_t> missing = missing_blocks(results, options_.trials, options_.shard);
        if (last_would_grow(results, options_.trials)) take_back_last(s);
        for (const std::int64_t block : missing) {
            tasks.push_back({s, block});
            progress_.total += trials_in_block(options_.trials, block);
        }
        done_[s] = results.blocks;
        std::vector<std::int64_t> planned;
        std::set_union(done_[s].begin(), done_[s].end(), missing.begin(), missing.end(), std::back_inserter(planned));
        set_blocks(results, std::move(planned), options_.trials);
    }

    void take_back_last(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        const std::size_t last = results.blocks.size() - 1;
        const auto size = static_cast<int>(block_rows(results, last));
        remove_totals(results, run_block(*problems_[s], study_.root_seed, results.blocks[last], size));
        if (options_.keeper != nullptr) options_.keeper->take_back(s, results.blocks[last]);
        taken_back_.push_back({s, results.blocks[last]});
        set_blocks(results, {results.blocks.begin(), results.blocks.end() - 1}, options_.trials);
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
            if (stopped || (options_.stop && options_.stop())) continue;
            try {
                run_task(tasks[t]);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                trouble = std::current_exception();
                stopped = true;
            }
        }
        if (trouble) std::rethrow_exception(trouble);
        for (const Task& task : taken_back_)  // what was there is not lost to a stop
            if (std::count(done_[task.scenario].begin(), done_[task.scenario].end(), task.block) == 0) run_task(task);
        if (options_.keeper == nullptr) return;
        options_.keeper->prepare(study_);
        options_.keeper->commit();
    }

    void run_task(const Task& task) {
        const int trials = trials_in_block(options_.trials, task.block);
        const Block block = run_block(*problems_[task.scenario], study_.root_seed, task.block, trials);
        store_columns(study_.scenarios[task.scenario], block);
        if (finish_task(task, block)) options_.keeper->commit();
    }

    /// Adds the block's totals; returns whether a commit was prepared.
    bool finish_task(const Task& task, const Block& block) {
        const std::lock_guard lock(mutex_);
        add_totals(study_.scenarios[task.scenario], block);
        done_[task.scenario].push_back(task.block);
        progress_.done += block.trials;
        report();
        if (options_.keeper == nullptr) return false;
        options_.keeper->take(task.scenario, block);
        if (!options_.keeper->due()) return false;
        options_.keeper->prepare(study_);
        return true;
    }

    /// After an early stop: only what is done is there.
    void leave_out_missing() {
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s) {
            std::sort(done_[s].begin(), done_[s].end());
            set_blocks(study_.scenarios[s], std::move(done_[s]), options_.trials);
        }
    }

    void report() {
        progress_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (options_.progress) options_.progress(progress_);
    }

    Study& study_;
    const RunOptions& options_;
    std::vector<std::unique_ptr<Problem>> problems_;
    std::vector<std::vector<std::int64_t>> done_;  ///< by scenario: blocks that are there
    std::vector<Task> taken_back_;                 ///< partial blocks: computed again even where the run is stopped
    std::mutex mutex_;                             ///< of totals, done_, progress and the keeper
    Progress progress_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Columns of a file cannot grow there.
void bring_into_memory(ScenarioResults& results) {
    for (ArmResults& arm : results.arms) {
        if (!arm.kept) continue;
        for (std::size_t c = 0; c < results.columns.size(); ++c)
            arm.columns.push_back(column_values(results, arm, c));
        arm.kept.reset();
    }
}

}  // namespace

Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed) {
    Study study{root_seed, {}, 0, false};
    std::set<std::string> names;
    for (const Scenario& scenario : scenarios) {
        if (!names.insert(scenario.name).second)
            throw invalid_value("scenario.name", scenario.name, "two scenarios of the run have it",
                                "Give each its own name");
        study.scenarios.push_back(empty_results(scenario));
    }
    return study;
}

std::vector<std::int64_t> missing_blocks(const ScenarioResults& results, std::int64_t trials, const Shard& shard) {
    std::vector<std::int64_t> missing;
    auto there = results.blocks.begin();
    for (std::int64_t block = shard.index; block < block_count(trials); block += shard.count) {
        there = std::lower_bound(there, results.blocks.end(), block);
        if (there == results.blocks.end() || *there != block) missing.push_back(block);
    }
    if (last_would_grow(results, trials))
        missing.insert(std::lower_bound(missing.begin(), missing.end(), results.blocks.back()), results.blocks.back());
    return missing;
}

std::int64_t least_trials(const Study& study) {
    std::int64_t least = study.trials;
    for (const ScenarioResults& results : study.scenarios)
        if (!results.blocks.empty())
            least = std::max(least, results.blocks.back() * block_size + block_rows(results, results.blocks.size() - 1));
    return least;
}

void run_study(Study& study, const RunOptions& options) {
    if (const std::int64_t least = least_trials(study); least > options.trials)
        throw invalid_value("--trials", std::to_string(options.trials),
                            "the study has been asked for " + std::to_string(least) + " already",
                            "Ask for at least as many");
    if (options.keeper == nullptr)
        for (ScenarioResults& results : study.scenarios) bring_into_memory(results);
    Runner(study, options).run();
}

}  // namespace credence
