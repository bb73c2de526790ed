#pragma once
// Which blocks a run computes, in which order, and which of them are done.

#include <credence/study.hpp>

#include <atomic>
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

}  // namespace credence
