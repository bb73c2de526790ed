// Running a study's blocks on threads, and on a crew.

#include <credence/crew.hpp>

#include <credence/error.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>

namespace credence {

namespace {

/// Runs tasks on threads and puts their results into the study. Totals are exact, so the order does not matter.
class Runner : private BlockDesk {
public:
    Runner(Study& study, const RunOptions& options) : study_(study), options_(options), done_(study.scenarios.size()) {
        for (const ScenarioResults& results : study.scenarios)
            runners_.emplace_back(results.scenario);
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
    /// Takes back a partial last block that will be larger, makes room, and lists the blocks that are missing.
    void prepare(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        BlockRanges missing = missing_blocks(results, options_.trials, options_.shard), planned = missing;
        if (last_would_grow(results, options_.trials)) take_back_last(s);
        progress_.total += trials_in(missing, options_.trials);
        task_count_ += missing.size();
        missing_.push_back(std::move(missing));
        done_[s] = results.blocks;
        planned.add(done_[s]);
        set_blocks(results, std::move(planned), options_.trials);
    }

    void take_back_last(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        const std::int64_t last = results.blocks.back();
        const auto size = static_cast<int>(block_rows(results, results.blocks.size() - 1));
        remove_totals(results, runners_[s].run(study_.root_seed, last, size));
        if (options_.keeper != nullptr) options_.keeper->take_back(s, last);
        taken_back_.push_back({s, last});
        set_blocks(results, results.blocks.without({last}), options_.trials);
    }

    void run_tasks() {
        const int threads = options_.threads > 0 ? options_.threads : omp_get_max_threads();
        const int servers = options_.crew != nullptr ? 1 : 0;
        report();
        // Thread 0 is the one that called run_study. It computes nothing where there is a crew: nobody of it is to
        // wait.
#pragma omp parallel num_threads(threads + servers)
        if (omp_get_thread_num() < servers)
            guarded([&] { options_.crew->serve(*this); });
        else
            while (const std::optional<Task> task = next_task()) guarded([&] { run_task(*task); });
        if (trouble_) std::rethrow_exception(trouble_);
        for (const Task& task : taken_back_)  // what was there is not lost to a stop
            if (!done_[task.scenario].contains(task.block)) run_task(task);
        if (options_.keeper == nullptr) return;
        options_.keeper->prepare(study_);
        options_.keeper->commit();
    }

    /// An exception must not leave the parallel region (nor an omp critical one): it is kept, and thrown after it.
    template <class Work>
    void guarded(Work work) {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            trouble_ = std::current_exception();
            stopped_ = true;
        }
    }

    std::optional<Task> next_task() {
        if (next_ >= task_count_ || stopped()) return std::nullopt;
        std::size_t place = next_++;
        for (std::size_t s = 0; s < missing_.size(); place -= missing_[s++].size())
            if (place < missing_[s].size()) return Task{s, missing_[s][place]};
        return std::nullopt;
    }

    void run_task(const Task& task) {
        const int trials = trials_in_block(options_.trials, task.block);
        const Block block = runners_[task.scenario].run(study_.root_seed, task.block, trials);
        ScenarioResults& results = study_.scenarios[task.scenario];
        store_columns(results, block);
        if (finish_task(task, block, block_aggregates(results, block))) options_.keeper->commit();
    }

    /// Adds the block's totals; returns whether a commit was prepared.
    bool finish_task(const Task& task, const Block& block, const std::vector<ArmAggregates>& aggregates) {
        const std::lock_guard lock(mutex_);
        add_totals(study_.scenarios[task.scenario], block, aggregates);
        if (options_.keeper != nullptr) options_.keeper->take(task.scenario, block);
        finished(task);
        report();
        return prepare_commit();
    }

    void finished(const Task& task) {
        done_[task.scenario].add(task.block);
        progress_.done += trials_in_block(options_.trials, task.block);
    }

    bool prepare_commit() {
        if (options_.keeper == nullptr || !options_.keeper->due()) return false;
        options_.keeper->prepare(study_);
        return true;
    }

    // What the crew sees [BlockDesk].
    std::int64_t trials() const override { return options_.trials; }
    std::int64_t left() const override {
        return static_cast<std::int64_t>(task_count_ - std::min(task_count_, next_.load()));
    }
    std::vector<Task> hand_out(std::int64_t most) override {
        std::vector<Task> tasks;
        while (static_cast<std::int64_t>(tasks.size()) < most) {
            const std::optional<Task> task = next_task();
            if (!task) break;
            tasks.push_back(*task);
        }
        return tasks;
    }
    bool stopped() override {
        if (!stopped_ && options_.stop && options_.stop()) stopped_ = true;
        return stopped_;
    }
    void take(const ComputedBlocks& computed) override {
        ScenarioResults& results = study_.scenarios[computed.scenario];
        for (const std::int64_t block : computed.blocks) copy_details(results, computed.results, block);
        if (add(results, computed)) options_.keeper->commit();
    }

    bool add(ScenarioResults& results, const ComputedBlocks& computed) {
        const std::lock_guard lock(mutex_);
        for (std::size_t a = 0; a < results.arms.size(); ++a) add_totals(results.arms[a], computed.results.arms[a]);
        options_.keeper->take(computed.scenario, computed.blocks, computed.values);
        for (const std::int64_t block : computed.blocks) finished({computed.scenario, block});
        report();
        return prepare_commit();
    }

    /// After an early stop: only what is done is there.
    void leave_out_missing() {
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s)
            set_blocks(study_.scenarios[s], std::move(done_[s]), options_.trials);
    }

    void report() {
        progress_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (options_.progress) options_.progress(progress_);
    }

    Study& study_;
    const RunOptions& options_;
    std::vector<BlockRunner> runners_;
    std::vector<BlockRanges> done_;      ///< by scenario: blocks that are there
    std::vector<BlockRanges> missing_;   ///< likewise: those that are this run's tasks, one scenario after the other
    std::size_t task_count_ = 0;
    std::atomic<std::size_t> next_ = 0;  ///< the first task that nobody has
    std::atomic<bool> stopped_ = false;
    std::exception_ptr trouble_;
    std::vector<Task> taken_back_;  ///< partial blocks: computed again even where the run is stopped
    std::mutex mutex_;              ///< of totals, done_, progress and the keeper
    Progress progress_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Columns of a file cannot grow there.
void bring_into_memory(ScenarioResults& results) {
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
    if (options.crew != nullptr && options.keeper == nullptr) throw std::logic_error("a crew needs a keeper");
    if (options.keeper == nullptr)
        for (ScenarioResults& results : study.scenarios) bring_into_memory(results);
    Runner(study, options).run();
}

}  // namespace credence
