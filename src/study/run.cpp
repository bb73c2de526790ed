// Running a study's blocks on threads.

#include "base/idle_threads.hpp"
#include "study/block_results.hpp"

#include <credence/error.hpp>
#include <credence/study.hpp>
#include <credence/detail/worlds.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace credence {

namespace {

/// One block to run: which scenario, which block.
struct Task {
    std::size_t scenario = 0;
    std::int64_t block = 0;
};

/// Runs tasks on threads and adds their results to the study. Totals are exact, so the order does not matter.
class Runner {
public:
    Runner(Study& study, const RunOptions& options) : study_(study), options_(options) {
        for (const ScenarioResults& results : study.scenarios) work_.emplace_back(results.scenario);
    }

    void run() {
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s) prepare(s);
        study_.trials = options_.trials;
        run_tasks();
        if (progress_.done < progress_.total) leave_out_missing();
        study_.complete = true;
        for (const ScenarioResults& results : study_.scenarios)
            study_.complete = study_.complete && missing_blocks(results, study_.trials).empty();
        if (options_.keeper != nullptr) options_.keeper->finished(study_);
    }

private:
    /// The tasks of a run for one scenario.
    struct Work {
        explicit Work(const Scenario& scenario) : runner(world_of(scenario), scenario) {}

        BlockRunner runner;
        BlockRanges done;      ///< blocks that are present
        BlockRanges missing;   ///< blocks that this run computes
        std::size_t left = 0;  ///< the number of these that are not finished
        Task partial;          ///< the last block, where it is present with fewer trials than it will have
        int partial_trials = 0;///< that it has; 0: there is none
        bool begun = false;
    };

    /// Allocates the rows, and lists the missing blocks.
    void prepare(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        Work& work = work_[s];
        work.missing = missing_blocks(results, options_.trials, options_.shard);
        work.done = results.blocks;
        if (last_would_grow(results, options_.trials)) {
            work.partial = {s, results.blocks.back()};
            work.partial_trials = static_cast<int>(block_rows(results, results.blocks.size() - 1));
            work.done.remove(work.partial.block);
        }
        if (has_totals(results)) held_ += size_of(results);
        BlockRanges planned = work.missing;
        planned.add(work.done);
        progress_.total += trials_in(work.missing, options_.trials);
        task_count_ += work.left = work.missing.size();
        set_blocks(results, std::move(planned), options_.trials);
    }

    static std::int64_t size_of(const ScenarioResults& results) { return totals_size(results, results.detailed()); }

    /// Called before a block is computed: waits while too many others wait to be committed, and prepares its scenario.
    void begin(std::size_t s) {
        std::unique_lock lock(mutex_);
        if (options_.keeper != nullptr && options_.keeper->full()) {
            lock.unlock();
            { const std::lock_guard until_committed(committing_); }
            lock.lock();
        }
        if (work_[s].begun) return;
        const bool before = std::exchange(at_odds_, true);
        begin_scenario(s);
        at_odds_ = before;
    }

    /// Loads totals into memory, and removes a partial last block from them.
    void begin_scenario(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        Work& work = work_[s];
        if (!has_totals(results)) {
            load_totals(results);
            held_ += size_of(results);
        }
        if (work.partial_trials > 0) {
            remove_totals(results, work.runner.run(study_.root_seed, work.partial.block, work.partial_trials));
            if (options_.keeper != nullptr) options_.keeper->take_back(s, work.partial.block);
        }
        work.begun = true;
    }

    void run_tasks() {
        const int threads = options_.threads > 0 ? options_.threads : omp_get_max_threads();
        report();
#pragma omp parallel num_threads(threads)
        while (const std::optional<Task> task = next_task()) guarded(*task);
        end_idle_threads();
        if (trouble_) std::rethrow_exception(trouble_);
        for (const Work& work : work_)  // blocks that were present are kept when a run is stopped
            if (work.partial_trials > 0 && !work.done.contains(work.partial.block)) run_task(work.partial);
        free_workspaces();
        if (options_.keeper == nullptr) return;
        prepare_all();
        commit();
    }

    /// An exception must not leave the parallel region (nor an omp critical one): it is stored, and thrown after the
    /// region.
    void guarded(const Task& task) {
        try {
            run_task(task);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            trouble_ = std::current_exception();
            stopped_ = true;
        }
    }

    std::optional<Task> next_task() {
        if (next_ >= task_count_ || stopped()) return std::nullopt;
        std::size_t place = next_++;
        for (std::size_t s = 0; s < work_.size(); place -= work_[s++].missing.size())
            if (place < work_[s].missing.size()) return Task{s, work_[s].missing[place]};
        return std::nullopt;
    }

    void run_task(const Task& task) {
        begin(task.scenario);
        const int trials = trials_in_block(options_.trials, task.block);
        const Block block = work_[task.scenario].runner.run(study_.root_seed, task.block, trials);
        ScenarioResults& results = study_.scenarios[task.scenario];
        store_columns(results, block);
        if (finish_task(task, block, trial_totals_of(results, block))) commit();
    }

    /// Adds the block's totals; returns whether a commit was prepared. Where that throws, such as for want of memory,
    /// the totals and what the keeper has of them are at odds: what other threads still finish is left out, or they
    /// would commit it.
    bool finish_task(const Task& task, const Block& block, const std::vector<TrialTotals>& of_trials) {
        const std::lock_guard lock(mutex_);
        if (at_odds_) return false;
        at_odds_ = true;
        add_totals(study_.scenarios[task.scenario], block, of_trials);
        if (options_.keeper != nullptr) options_.keeper->take(task.scenario, block);
        finished(task);
        report();
        const bool prepared = prepare_commit();
        at_odds_ = false;
        return prepared;
    }

    void finished(const Task& task) {
        Work& work = work_[task.scenario];
        work.done.add(task.block);
        progress_.done += trials_in_block(options_.trials, task.block);
        if (--work.left > 0) return;
        finished_.push_back(task.scenario);
        finished_size_ += size_of(study_.scenarios[task.scenario]);
    }

    bool prepare_commit() {
        if (options_.keeper == nullptr || !options_.keeper->due(too_much_held() ? finished_size_ : 0)) return false;
        prepare_all();
        return true;
    }

    bool too_much_held() const { return held_ > options_.most_totals; }

    /// Prepares a commit of all blocks taken so far. The keeper then has the totals of the finished scenarios.
    void prepare_all() {
        options_.keeper->prepare(study_);
        if (!too_much_held()) return;
        for (const std::size_t s : finished_)
            if (study_.scenarios[s].kept_totals) drop_totals(study_.scenarios[s]);
        finished_.clear();
        held_ -= finished_size_;
        finished_size_ = 0;
    }

    void commit() {
        const std::lock_guard one(committing_);
        options_.keeper->commit();
    }

    /// Whether the run has to stop, because that was requested or because of an error.
    bool stopped() {
        if (!stopped_ && options_.stop && options_.stop()) stopped_ = true;
        return stopped_;
    }

    /// After an early stop: keeps only the rows of blocks that are done.
    void leave_out_missing() {
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s)
            set_blocks(study_.scenarios[s], std::move(work_[s].done), options_.trials);
    }

    void report() {
        progress_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (options_.progress) options_.progress(progress_);
    }

    Study& study_;
    const RunOptions& options_;
    std::vector<Work> work_;             ///< by scenario; its tasks, one scenario after the other
    std::size_t task_count_ = 0;
    std::atomic<std::size_t> next_ = 0;  ///< the first task that has not been handed out
    std::atomic<bool> stopped_ = false;
    bool at_odds_ = false;          ///< a change of totals and keeper has begun and not ended
    std::exception_ptr trouble_;
    std::mutex mutex_;              ///< of totals, work_, progress and the keeper
    std::mutex committing_;         ///< locked while a commit is made
    std::vector<std::size_t> finished_;  ///< scenarios whose tasks are done, and whose totals are in memory
    std::int64_t held_ = 0, finished_size_ = 0;  ///< bytes of totals in memory, and those of `finished_`
    Progress progress_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Columns that are kept in a file cannot grow there.
void bring_into_memory(ScenarioResults& results) {
    load_totals(results);
    results.kept_totals.reset();
    for (ArmResults& arm : results.arms) {
        if (!arm.kept) continue;
        for (std::size_t c = 0; c < results.columns.size(); ++c) arm.columns.push_back(column_values(results, arm, c));
        arm.kept.reset();
    }
}

}  // namespace

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
