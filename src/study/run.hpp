#pragma once
// The parts of a run: which blocks it computes and which of them are done, and its commits to its keeper with the
// totals that stay in memory between them.

#include <credence/study.hpp>

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

namespace credence {

/// One block to run: which scenario, which block.
struct Task {
    std::size_t scenario = 0;
    std::int64_t block = 0;
};

/// The tasks of a run, one scenario after the other. `next` may be called from several threads.
class Schedule {
public:
    /// Lists the missing blocks and allocates the rows of the study's kept columns for them.
    Schedule(Study& study, const RunOptions& options);

    std::optional<Task> next();

    /// A last block that is present with fewer trials than it will have; nothing where there is none. It is to be
    /// removed from the totals and computed again.
    struct Partial {
        Task task;
        int trials = 0;  ///< that it has
    };
    const std::optional<Partial>& partial(std::size_t scenario) const { return scenarios_[scenario].partial; }
    bool is_done(const Task& task) const { return scenarios_[task.scenario].done.contains(task.block); }

    /// Notes that a task is done; returns whether it was its scenario's last one.
    bool finish(const Task& task);
    /// Trials that are done, of those of all tasks.
    const Progress& progress() const { return progress_; }

    /// After an early stop: keeps only the rows of blocks that are done.
    void leave_out_missing(Study& study);

private:
    struct OfScenario {
        BlockRanges done;      ///< blocks that are present
        BlockRanges missing;   ///< blocks that this run computes
        std::size_t left = 0;  ///< the number of these that are not finished
        std::optional<Partial> partial{};
    };

    std::int64_t trials_;
    std::vector<OfScenario> scenarios_;
    std::size_t task_count_ = 0;
    std::atomic<std::size_t> next_ = 0;  ///< the first task that has not been handed out
    Progress progress_;
};

/// Does nothing without a keeper. One thread at a time calls the functions, but for `wait_for_room` and `commit`.
class Commits {
public:
    Commits(const Study& study, const RunOptions& options);

    /// Waits while too many blocks wait to be committed.
    void wait_for_room(std::unique_lock<std::mutex>& lock);

    /// Totals of a scenario were loaded into memory.
    void loaded(const ScenarioResults& results);
    /// The last block of a scenario has been added.
    void finished(const Study& study, std::size_t scenario);

    void take(std::size_t scenario, const Block& block);
    void take_back(std::size_t scenario, std::int64_t block);

    /// Prepares a commit of all blocks taken so far, if it is due; returns whether it was. Totals of finished scenarios
    /// that the keeper then has may leave the memory.
    bool prepare_if_due(Study& study);
    void prepare(Study& study);
    /// Makes the prepared commit durable.
    void commit();

private:
    bool too_much_held() const { return held_ > most_totals_; }

    BlockKeeper* keeper_;
    std::int64_t most_totals_;
    std::mutex committing_;              ///< locked while a commit is made
    std::vector<std::size_t> finished_;  ///< scenarios whose tasks are done, and whose totals are in memory
    std::int64_t held_ = 0, finished_size_ = 0;  ///< bytes of totals in memory, and those of `finished_`
};

}  // namespace credence
