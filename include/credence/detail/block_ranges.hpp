#pragma once
// Module totals: sets of a study's blocks, stored as ranges: a complete study is one range, however many blocks it has.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <vector>

namespace credence {

/// Trials in a block; the last one of a study may have fewer.
inline constexpr int block_size = 256;

/// Number of blocks that hold `trials` trials, and the number of trials in block `index` of them.
constexpr std::int64_t block_count(std::int64_t trials) { return (trials + block_size - 1) / block_size; }
constexpr int trials_in_block(std::int64_t trials, std::int64_t index) {
    const std::int64_t left = trials - index * block_size;
    return left < block_size ? static_cast<int>(left) : block_size;
}

/// Blocks first, first + 1 ... last.
struct BlockRange {
    std::int64_t first = 0, last = 0;

    std::int64_t count() const { return last - first + 1; }
    bool operator==(const BlockRange&) const = default;
};

/// A set of blocks as increasing ranges of 24 bytes each, whatever their length. Ranges neither overlap nor are
/// adjacent, so that equal sets have equal ranges. In one shard of several, each block is a range.
class BlockRanges {
public:
    BlockRanges() = default;
    /// In any order.
    BlockRanges(const std::vector<std::int64_t>& blocks);
    BlockRanges(std::initializer_list<std::int64_t> blocks) : BlockRanges(std::vector<std::int64_t>(blocks)) {}
    /// 0, 1 ... count - 1
    static BlockRanges below(std::int64_t count);

    bool empty() const { return spans_.empty(); }
    std::size_t size() const { return static_cast<std::size_t>(count()); }
    std::int64_t count() const { return spans_.empty() ? 0 : spans_.back().before + spans_.back().range.count(); }
    std::int64_t front() const { return spans_.front().range.first; }
    std::int64_t back() const { return spans_.back().range.last; }
    /// The block at index `place`.
    std::int64_t operator[](std::size_t place) const;
    bool contains(std::int64_t block) const { return place_of(block).has_value(); }
    /// The index of a block; nothing where it is not in the set.
    std::optional<std::int64_t> place_of(std::int64_t block) const;
    /// Number of blocks that are lower than this one.
    std::int64_t count_below(std::int64_t block) const;
    std::vector<BlockRange> ranges() const;

    /// Adds the blocks that are not in the set yet.
    void add(const BlockRange& range);
    void add(std::int64_t block) { add(BlockRange{block, block}); }
    void add(const BlockRanges& others);
    void remove(std::int64_t block) { *this = without({block}); }
    /// The difference to the others, and the intersection with them.
    BlockRanges without(const BlockRanges& others) const;
    BlockRanges common(const BlockRanges& others) const { return without(without(others)); }

    class Iterator;
    Iterator begin() const;
    Iterator end() const;

    friend bool operator==(const BlockRanges& a, const BlockRanges& b) { return a.spans_ == b.spans_; }

private:
    struct Span {
        BlockRange range;
        std::int64_t before;  ///< blocks of earlier ranges
        bool operator==(const Span&) const = default;
    };
    /// The first range that ends at `block` or above.
    std::size_t span_at(std::int64_t block) const;

    std::vector<Span> spans_;
};

/// Goes through the blocks one by one.
class BlockRanges::Iterator {
public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = std::int64_t;
    using difference_type = std::ptrdiff_t;
    using pointer = const std::int64_t*;
    using reference = std::int64_t;

    Iterator() = default;
    Iterator(const std::vector<Span>& spans, std::size_t span) : spans_(&spans), span_(span) { enter(); }
    std::int64_t operator*() const { return block_; }
    Iterator& operator++() {
        if (block_ == (*spans_)[span_].range.last) {
            ++span_;
            enter();
        } else {
            ++block_;
        }
        return *this;
    }
    Iterator operator++(int) {
        Iterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const Iterator&) const = default;

private:
    void enter() { block_ = span_ < spans_->size() ? (*spans_)[span_].range.first : 0; }

    const std::vector<Span>* spans_ = nullptr;
    std::size_t span_ = 0;
    std::int64_t block_ = 0;
};

inline BlockRanges::Iterator BlockRanges::begin() const { return {spans_, 0}; }
inline BlockRanges::Iterator BlockRanges::end() const { return {spans_, spans_.size()}; }

}  // namespace credence
