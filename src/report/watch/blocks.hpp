#pragma once
// Which blocks of a scenario a run has committed.

#include <credence/study.hpp>

#include <cstdint>
#include <optional>

namespace credence {

/// The blocks of a scenario, of which only the last may be partial: it may be replaced later.
struct WatchedBlocks {
    struct Partial {
        std::int64_t index = 0, trials = 0;
    };
    BlockRanges whole;
    std::optional<Partial> partial;

    /// Adds blocks of a study of `trials` trials. Throws BadBytes for a complete block that was added before.
    void add(const BlockRange& range, std::int64_t trials);
    /// Prepares for a new number of trials: a partial block that becomes larger is computed again.
    void asked(std::int64_t trials);
    std::int64_t trials() const { return block_size * whole.count() + (partial ? partial->trials : 0); }
    std::int64_t blocks() const { return whole.count() + (partial ? 1 : 0); }
    std::int64_t blocks_of(const Shard& shard) const;
    std::int64_t trials_of(const Shard& shard) const;
    bool contains(const WatchedBlocks& other) const;
};

/// The blocks of stored results.
WatchedBlocks blocks_of(const ScenarioResults& results);

/// A shard's blocks of `trials` trials, and the trials in them.
std::int64_t blocks_of_shard(const Shard& shard, std::int64_t trials);
std::int64_t trials_of_shard(const Shard& shard, std::int64_t trials);

}  // namespace credence
