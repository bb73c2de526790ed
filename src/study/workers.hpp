#pragma once
// The interface to other processes that compute blocks of a study beside this one. How they communicate is not part of
// it [src/cluster/ranks.hpp].

#include <credence/study.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// One block to run: which scenario, which block.
struct Task {
    std::size_t scenario = 0;
    std::int64_t block = 0;
};

/// Blocks of one scenario that another process has computed.
struct ComputedBlocks {
    std::size_t scenario = 0;
    std::vector<std::int64_t> blocks;  ///< in the order of `values`
    std::string values;                ///< their columns and details, in the format of the study's keeper
    ScenarioResults results;           ///< totals and details of just these blocks, no columns
};

/// The engine's interface for the workers: it hands out the tasks of a run and takes the results. One thread at a time
/// calls it.
class BlockQueue {
public:
    virtual ~BlockQueue() = default;
    /// Number of trials of each scenario in this run.
    virtual std::int64_t trials() const = 0;
    /// Number of tasks that were not handed out yet.
    virtual std::int64_t left() const = 0;
    /// The next tasks, at most `most`; none where the run has to stop.
    virtual std::vector<Task> hand_out(std::int64_t most) = 0;
    /// Whether the run has to stop, because that was requested or because of an error.
    virtual bool stopped() = 0;
    /// Takes blocks that were handed out, and commits them where that is due. Throws what the keeper throws.
    virtual void take(const ComputedBlocks& computed) = 0;
};

/// Processes that compute blocks of a study.
class Workers {
public:
    virtual ~Workers() = default;
    /// Hands tasks out and takes their results, until all tasks are handed out and finished, or are given up because
    /// the run has to stop. It runs on the thread that called run_study, while other threads of this process compute
    /// blocks. Throws Failure where a process is lost.
    virtual void serve(BlockQueue& queue) = 0;
};

}  // namespace credence
