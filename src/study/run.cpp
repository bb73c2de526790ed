// Running a study's blocks on threads.

#include "base/idle_threads.hpp"
#include "base/wording.hpp"
#include "study/block_results.hpp"
#include "study/run.hpp"

#include <credence/error.hpp>
#include <credence/detail/worlds.hpp>

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <set>
#include <string>
#include <utility>

namespace credence {

namespace {

/// Runs tasks on threads and adds their results to the study. Totals are exact, so the order does not matter.
class Runner {
public:
    Runner(Study& study, const RunOptions& options)
        : study_(study), options_(options), commits_(study, options), schedule_(study, options) {
        for (const ScenarioResults& results : study.scenarios)
            runners_.emplace_back(world_of(results.scenario), results.scenario);
        begun_.resize(study.scenarios.size());
        std::set<std::string> worlds;  // scenarios of one world have the same function
        for (std::size_t s = 0; s < runners_.size() && schedule_.progress().done < schedule_.progress().total; ++s)
            if (worlds.insert(study.scenarios[s].scenario.world).second) runners_[s].check_repeats(study.root_seed);
    }

    void run() {
        study_.trials = options_.trials;
        run_tasks();
        if (schedule_.progress().done < schedule_.progress().total) schedule_.leave_out_missing(study_);
        study_.complete = true;
        for (const ScenarioResults& results : study_.scenarios)
            study_.complete = study_.complete && missing_blocks(results, study_.trials).empty();
        if (options_.keeper != nullptr) options_.keeper->finished(study_);
    }

private:
    /// Called before a block is computed: waits while too many others wait to be committed, and prepares its scenario.
    void begin(std::size_t s) {
        std::unique_lock lock(mutex_);
        commits_.wait_for_room(lock);
        if (begun_[s]) return;
        const bool before = std::exchange(at_odds_, true);
        begin_scenario(s);
        at_odds_ = before;
    }

    /// Loads totals into memory, and removes a partial last block from them.
    void begin_scenario(std::size_t s) {
        ScenarioResults& results = study_.scenarios[s];
        if (!has_totals(results)) {
            load_totals(results);
            commits_.loaded(results);
        }
        if (const auto& partial = schedule_.partial(s)) {
            remove_totals(results, runners_[s].run(study_.root_seed, partial->task.block, partial->trials));
            commits_.take_back(s, partial->task.block);
        }
        begun_[s] = true;
    }

    void run_tasks() {
        const int threads = options_.threads > 0 ? options_.threads : omp_get_max_threads();
        report();
#pragma omp parallel num_threads(threads)
        while (const std::optional<Task> task = next_task()) guarded(*task);
        end_idle_threads();
        if (trouble_) std::rethrow_exception(trouble_);
        for (std::size_t s = 0; s < study_.scenarios.size(); ++s) {
            const auto& partial = schedule_.partial(s);  // blocks that were present are kept when a run is stopped
            if (partial && !schedule_.is_done(partial->task)) run_task(partial->task);
        }
        free_workspaces();
        commits_.prepare(study_);
        commits_.commit();
    }

    std::optional<Task> next_task() { return stopped() ? std::nullopt : schedule_.next(); }

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

    void run_task(const Task& task) {
        begin(task.scenario);
        const int trials = trials_in_block(options_.trials, task.block);
        const Block block = runners_[task.scenario].run(study_.root_seed, task.block, trials);
        ScenarioResults& results = study_.scenarios[task.scenario];
        store_columns(results, block);
        if (finish_task(task, block, trial_totals_of(results, block))) commits_.commit();
    }

    /// Adds the block's totals; returns whether a commit was prepared. Where that throws, such as for want of memory,
    /// the totals and what the keeper has of them are at odds: what other threads still finish is left out, or they
    /// would commit it.
    bool finish_task(const Task& task, const Block& block, const std::vector<TrialTotals>& of_trials) {
        const std::lock_guard lock(mutex_);
        if (at_odds_) return false;
        at_odds_ = true;
        add_totals(study_.scenarios[task.scenario], block, of_trials);
        for (std::size_t a = 0; a < block.arms.size() && options_.times != nullptr; ++a) {
            ArmTime& time = (*options_.times)[study_.scenarios[task.scenario].arms[a].name];
            time.trials += block.trials;
            time.seconds += block.arms[a].seconds;
        }
        commits_.take(task.scenario, block);
        if (schedule_.finish(task)) commits_.finished(study_, task.scenario);
        report();
        const bool prepared = commits_.prepare_if_due(study_);
        at_odds_ = false;
        return prepared;
    }

    /// Whether the run has to stop, because that was requested or because of an error.
    bool stopped() {
        if (!stopped_ && options_.stop && options_.stop()) stopped_ = true;
        return stopped_;
    }

    void report() const {
        Progress now = schedule_.progress();
        now.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (options_.progress) options_.progress(now);
    }

    Study& study_;
    const RunOptions& options_;
    std::mutex mutex_;              ///< of totals, begun_, the schedule's progress and commits_
    Commits commits_;
    Schedule schedule_;
    std::vector<BlockRunner> runners_;  ///< by scenario
    std::vector<char> begun_;           ///< by scenario
    std::atomic<bool> stopped_ = false;
    bool at_odds_ = false;              ///< a change of totals and keeper has begun and not ended
    std::exception_ptr trouble_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Columns that are kept in a file cannot grow there.
void bring_into_memory(ScenarioResults& results) {
    load_totals(results);
    results.kept_totals.reset();
    for (ArmResults& arm : results.arms) {
        if (!arm.columns.kept()) continue;
        ArmColumns columns;
        for (std::size_t c = 0; c < results.columns.size(); ++c)
            columns.in_memory().push_back(column_values(results, arm, c));
        arm.columns = std::move(columns);
    }
}

}  // namespace

void run_study(Study& study, const RunOptions& options) {
    if (const std::int64_t least = least_trials(study); least > options.trials)
        throw invalid_value(as_option("trials"), std::to_string(options.trials),
                            "the study has been asked for " + std::to_string(least) + " already",
                            "Ask for at least as many");
    if (options.keeper == nullptr)
        for (ScenarioResults& results : study.scenarios) bring_into_memory(results);
    Runner(study, options).run();
}

}  // namespace credence
