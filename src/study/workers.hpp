#pragma once
// Other processes that compute blocks of a study beside this one. How they are reached is not the engine's
// affair [ranks.hpp].

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

/// Blocks of one scenario that another process computed.
struct ComputedBlocks {
    std::size_t scenario = 0;
    std::vector<std::int64_t> blocks;  ///< in the order of `values`
    std::string values;                ///< their columns and details, as the study's keeper keeps them
    ScenarioResults results;           ///< just these blocks: totals and details, no columns
};

/// What the engine has for a crew: the tasks of a run that nobody has yet, and a place for what becomes of them. One
/// thread at a time calls it.
class BlockQueue {
public:
    virtual ~BlockQueue() = default;
    /// Trials of each scenario that the run was asked for.
    virtual std::int64_t trials() const = 0;
    /// Tasks that were not given to anybody yet.
    virtual std::int64_t left() const = 0;
    /// The next tasks, `most` at most; none where the run is to stop.
    virtual std::vector<Task> hand_out(std::int64_t most) = 0;
    /// Whether the run is to stop, because it was asked to or because something failed.
    virtual bool stopped() = 0;
    /// Takes blocks that were handed out, and commits them where that is due. Throws what the keeper throws.
    virtual void take(const ComputedBlocks& computed) = 0;
};

/// Processes that compute blocks of a study.
class Workers {
public:
    virtual ~Workers() = default;
    /// Hands tasks out and takes what comes back, until nothing is left to hand out and all that was is back, or is given
    /// up because the run is to stop. On the thread that called run_study, while others of this process compute blocks
    /// too. Throws Failure where a process is lost.
    virtual void serve(BlockQueue& queue) = 0;
};

}  // namespace credence
