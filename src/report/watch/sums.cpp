#include "report/watch/sums.hpp"

#include "report/watch/watch.hpp"

#include "base/bytes.hpp"
#include "base/nan.hpp"

#include <algorithm>

namespace credence {

namespace {

Status status_of(double value) { return static_cast<Status>(static_cast<int>(value)); }

/// An arm's column, failed trials as NaN.
std::vector<double> figure_of(const ColumnOf& column, std::size_t arm, std::size_t index,
                              const std::vector<double>& status) {
    std::vector<double> values = column(arm, index);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (failed(status_of(status[i]))) values[i] = nan;
    return values;
}

bool is_of(const Shard& shard, std::int64_t block) { return block % shard.count == shard.index; }

/// Number of a shard's blocks.
std::int64_t count_of(const BlockRanges& blocks, const Shard& shard) {
    std::int64_t count = 0;
    for (const BlockRange& range : blocks.ranges())
        count +=
            blocks_of_shard(shard, block_size * (range.last + 1)) - blocks_of_shard(shard, block_size * range.first);
    return count;
}

RunningMoments running(const ExactMoments& exact) {
    const Moments moments = moments_of(exact);
    if (exact.count < 2) return {exact.count, exact.count > 0 ? moments.mean : 0, 0};
    return {exact.count, moments.mean, moments.standard_deviation * moments.standard_deviation * (moments.count - 1)};
}

}  // namespace

std::vector<std::size_t> watched_columns(const std::vector<Column>& columns) {
    std::vector<std::size_t> watched;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (is_reported(columns[c]) && columns[c].name != "mean_trace_P") watched.push_back(c);
    return watched;
}

void WatchedSums::add(const WatchedSums& other) {
    trials += other.trials;
    arms.resize(std::max(arms.size(), other.arms.size()));
    for (std::size_t a = 0; a < other.arms.size(); ++a) {
        const ArmSums& from = other.arms[a];
        arms[a].columns.resize(from.columns.size());
        for (std::size_t f = 0; f < from.columns.size(); ++f) arms[a].columns[f].add(from.columns[f]);
        arms[a].difference.add(from.difference);
        arms[a].failed += from.failed;
        arms[a].diverged += from.diverged;
    }
}

WatchedSums sums_of(const ScenarioResults& results, std::int64_t trials, const ColumnOf& column) {
    WatchedSums sums{trials, std::vector<ArmSums>(results.arms.size())};
    std::vector<std::vector<double>> trace(results.arms.size());
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        ArmSums& arm = sums.arms[a];
        const std::vector<double> status = column(a, status_column(results.columns));
        for (const double value : status) {
            arm.failed += failed(status_of(value));
            arm.diverged += status_of(value) == Status::diverged;
        }
        for (const std::size_t index : watched_columns(results.columns)) {
            const std::vector<double> values = figure_of(column, a, index, status);
            arm.columns.push_back(RunningMoments::of(values));
            if (index == 0) trace[a] = values;
        }
    }
    for (std::size_t a = 0; a < results.arms.size(); ++a)
        if (const ArmResults* fixed = baseline_of(results, results.arms[a])) {
            const auto baseline = static_cast<std::size_t>(fixed - results.arms.data());
            sums.arms[a].difference = RunningMoments::of(paired_differences(trace[a], trace[baseline]));
        }
    return sums;
}

WatchedSums sums_of_aggregates(const ScenarioResults& results) {
    WatchedSums sums{results.trials, std::vector<ArmSums>(results.arms.size())};
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmResults& arm = results.arms[a];
        sums.arms[a].failed = arm.aggregates.trials() - arm.aggregates.counted();
        sums.arms[a].diverged = arm.aggregates.statuses[static_cast<std::size_t>(Status::diverged)];
        for (const std::size_t index : watched_columns(results.columns))
            sums.arms[a].columns.push_back(running(arm.aggregates.columns[index]));
        if (const ArmResults* fixed = baseline_of(results, arm))
            sums.arms[a].difference = running(aggregate_differences(results, arm, *fixed, 0).difference);
    }
    return sums;
}

WatchedSums sums_of_rows(const ScenarioResults& results, std::int64_t first, std::int64_t count) {
    if (results.keep == Keep::aggregates) return {count, {}};
    constexpr std::int64_t at_once = 64 * block_size;
    WatchedSums sums;
    for (std::int64_t row = first; row < first + count; row += at_once) {
        const std::int64_t some = std::min(at_once, first + count - row);
        sums.add(sums_of(results, some, [&](std::size_t arm, std::size_t column) {
            return column_values(results.arms[arm], column, row, some);
        }));
    }
    return sums;
}

void WatchedBlocks::add(std::int64_t index, WatchedSums of_block) {
    if (of_block.trials < block_size) {
        partial = Partial{index, std::move(of_block)};
        return;
    }
    if (whole.contains(index)) throw BadBytes("a block is there twice");
    whole.add(index);
    if (partial && partial->index == index) partial.reset();
    sums.add(of_block);
}

void WatchedBlocks::add(const BlockRange& range, std::int64_t trials) {
    const std::int64_t of_last = trials_in_block(trials, range.last);
    BlockRanges all;
    all.add(range);
    if (of_last < block_size) {
        all.remove(range.last);
        partial = Partial{range.last, {of_last, {}}};
    }
    if (!whole.common(all).empty()) throw BadBytes("a block is there twice");
    whole.add(all);
    if (partial && all.contains(partial->index)) partial.reset();
    sums.trials += block_size * all.count();
}

void WatchedBlocks::asked(std::int64_t trials) {
    if (partial && partial->sums.trials < trials_in_block(trials, partial->index)) partial.reset();
}

std::int64_t WatchedBlocks::blocks_of(const Shard& shard) const {
    return count_of(whole, shard) + (partial && is_of(shard, partial->index) ? 1 : 0);
}

std::int64_t WatchedBlocks::trials_of(const Shard& shard) const {
    return block_size * count_of(whole, shard) +
           (partial && is_of(shard, partial->index) ? partial->sums.trials : 0);
}

bool WatchedBlocks::contains(const WatchedBlocks& other) const {
    const bool has_partial = !other.partial || (partial && partial->index == other.partial->index &&
                                                partial->sums.trials == other.partial->sums.trials);
    return has_partial && other.whole.without(whole).empty();
}

void WatchedBlocks::add_to(WatchedSums& all) const {
    all.add(sums);
    if (partial) all.add(partial->sums);
}

WatchedBlocks blocks_of(const ScenarioResults& results) {
    WatchedBlocks blocks;
    blocks.whole = results.blocks;
    const std::int64_t in_whole = results.trials / block_size * block_size;
    blocks.sums = sums_of_rows(results, 0, in_whole);
    if (in_whole == results.trials) return blocks;
    const std::int64_t last = results.blocks.back();
    blocks.whole.remove(last);
    blocks.partial = WatchedBlocks::Partial{last, sums_of_rows(results, in_whole, results.trials - in_whole)};
    return blocks;
}

std::int64_t blocks_of_shard(const Shard& shard, std::int64_t trials) {
    const std::int64_t blocks = block_count(trials);
    return blocks <= shard.index ? 0 : (blocks - 1 - shard.index) / shard.count + 1;
}

std::int64_t trials_of_shard(const Shard& shard, std::int64_t trials) {
    const std::int64_t last = block_count(trials) - 1, blocks = blocks_of_shard(shard, trials);
    const bool has_last = blocks > 0 && is_of(shard, last);
    return block_size * blocks - (has_last ? block_size - trials_in_block(trials, last) : 0);
}

}  // namespace credence
