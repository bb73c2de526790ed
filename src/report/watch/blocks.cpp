#include "report/watch/blocks.hpp"

#include "base/bytes.hpp"

namespace credence {

namespace {

bool is_of(const Shard& shard, std::int64_t block) { return block % shard.count == shard.index; }

/// Number of a shard's blocks.
std::int64_t count_of(const BlockRanges& blocks, const Shard& shard) {
    std::int64_t count = 0;
    for (const BlockRange& range : blocks.ranges())
        count +=
            blocks_of_shard(shard, block_size * (range.last + 1)) - blocks_of_shard(shard, block_size * range.first);
    return count;
}

}  // namespace

void WatchedBlocks::add(const BlockRange& range, std::int64_t trials) {
    const std::int64_t of_last = trials_in_block(trials, range.last);
    BlockRanges all;
    all.add(range);
    if (of_last < block_size) {
        all.remove(range.last);
        partial = Partial{range.last, of_last};
    }
    if (!whole.common(all).empty()) throw BadBytes("a block is there twice");
    whole.add(all);
    if (partial && all.contains(partial->index)) partial.reset();
}

void WatchedBlocks::asked(std::int64_t trials) {
    if (partial && partial->trials < trials_in_block(trials, partial->index)) partial.reset();
}

std::int64_t WatchedBlocks::blocks_of(const Shard& shard) const {
    return count_of(whole, shard) + (partial && is_of(shard, partial->index) ? 1 : 0);
}

std::int64_t WatchedBlocks::trials_of(const Shard& shard) const {
    return block_size * count_of(whole, shard) + (partial && is_of(shard, partial->index) ? partial->trials : 0);
}

bool WatchedBlocks::contains(const WatchedBlocks& other) const {
    const bool has_partial = !other.partial || (partial && partial->index == other.partial->index &&
                                                partial->trials == other.partial->trials);
    return has_partial && other.whole.without(whole).empty();
}

WatchedBlocks blocks_of(const ScenarioResults& results) {
    WatchedBlocks blocks{results.blocks, {}};
    const std::int64_t left = results.trials % block_size;
    if (left == 0) return blocks;
    blocks.partial = WatchedBlocks::Partial{results.blocks.back(), left};
    blocks.whole.remove(results.blocks.back());
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
