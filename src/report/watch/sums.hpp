#pragma once
// The data that snapshots keep of the trials they have read: sums, and the blocks of these trials.

#include <credence/study.hpp>

#include "statistics/running_moments.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace credence {

struct ArmSums {
    std::vector<RunningMoments> columns;  ///< of the watched columns
    RunningMoments difference;            ///< trace_P - that of its baseline, where there is one
    std::int64_t failed = 0, diverged = 0;
};

/// One scenario's.
struct WatchedSums {
    std::int64_t trials = 0;
    std::vector<ArmSums> arms;

    void add(const WatchedSums& other);
};

/// A column of an arm, of the trials that are summed up.
using ColumnOf = std::function<std::vector<double>(std::size_t arm, std::size_t column)>;
WatchedSums sums_of(const ScenarioResults& results, std::int64_t trials, const ColumnOf& column);

/// The sums of results that keep no trial.
WatchedSums sums_of_aggregates(const ScenarioResults& results);

/// The sums of rows of stored results, read in parts. Where no trial is kept only their number is known.
WatchedSums sums_of_rows(const ScenarioResults& results, std::int64_t first, std::int64_t count);

/// A scenario's blocks and their sums. Only the last block may be partial, and it may be replaced later.
struct WatchedBlocks {
    struct Partial {
        std::int64_t index = 0;
        WatchedSums sums;
    };
    BlockRanges whole;
    WatchedSums sums;  ///< of the complete blocks
    std::optional<Partial> partial;

    /// Throws BadBytes for a complete block that was added before.
    void add(std::int64_t index, WatchedSums sums);
    /// The same for blocks, of a study of `trials` trials, of which no trial is kept.
    void add(const BlockRange& range, std::int64_t trials);
    /// Prepares for a new number of trials: a partial block that becomes larger is computed again.
    void asked(std::int64_t trials);
    std::int64_t trials() const { return sums.trials + (partial ? partial->sums.trials : 0); }
    std::int64_t blocks() const { return whole.count() + (partial ? 1 : 0); }
    std::int64_t blocks_of(const Shard& shard) const;
    std::int64_t trials_of(const Shard& shard) const;
    bool contains(const WatchedBlocks& other) const;
    void add_to(WatchedSums& all) const;
};

/// The blocks of stored results.
WatchedBlocks blocks_of(const ScenarioResults& results);

/// A shard's blocks of `trials` trials, and the trials in them.
std::int64_t blocks_of_shard(const Shard& shard, std::int64_t trials);
std::int64_t trials_of_shard(const Shard& shard, std::int64_t trials);

}  // namespace credence
