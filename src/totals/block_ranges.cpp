#include <credence/detail/block_ranges.hpp>

#include <algorithm>

namespace credence {

BlockRanges::BlockRanges(const std::vector<std::int64_t>& blocks) {
    std::vector<std::int64_t> rising = blocks;
    std::sort(rising.begin(), rising.end());
    for (const std::int64_t block : rising) add(block);
}

BlockRanges BlockRanges::below(std::int64_t count) {
    BlockRanges ranges;
    if (count > 0) ranges.add(BlockRange{0, count - 1});
    return ranges;
}

std::size_t BlockRanges::span_at(std::int64_t block) const {
    return static_cast<std::size_t>(
        std::lower_bound(spans_.begin(), spans_.end(), block,
                         [](const Span& span, std::int64_t value) { return span.range.last < value; }) -
        spans_.begin());
}

std::int64_t BlockRanges::operator[](std::size_t place) const {
    const auto index = static_cast<std::int64_t>(place);
    const auto above = std::upper_bound(spans_.begin(), spans_.end(), index,
                                        [](std::int64_t value, const Span& span) { return value < span.before; });
    const Span& span = *(above - 1);
    return span.range.first + index - span.before;
}

std::int64_t BlockRanges::count_below(std::int64_t block) const {
    const std::size_t at = span_at(block);
    if (at == spans_.size()) return count();
    return spans_[at].before + std::max<std::int64_t>(0, block - spans_[at].range.first);
}

std::optional<std::int64_t> BlockRanges::place_of(std::int64_t block) const {
    const std::size_t at = span_at(block);
    if (at == spans_.size() || block < spans_[at].range.first) return std::nullopt;
    return spans_[at].before + block - spans_[at].range.first;
}

std::vector<BlockRange> BlockRanges::ranges() const {
    std::vector<BlockRange> ranges;
    ranges.reserve(spans_.size());
    for (const Span& span : spans_) ranges.push_back(span.range);
    return ranges;
}

void BlockRanges::add(const BlockRange& range) {
    // Ranges that it overlaps or touches are joined with it. Usually it is at the end, and no range has to be moved.
    const std::size_t begin = span_at(range.first - 1);
    std::size_t end = begin;
    BlockRange all = range;
    for (; end < spans_.size() && spans_[end].range.first <= range.last + 1; ++end)
        all = {std::min(all.first, spans_[end].range.first), std::max(all.last, spans_[end].range.last)};
    const auto at = spans_.begin() + static_cast<std::ptrdiff_t>(begin);
    if (begin == end) {
        spans_.insert(at, Span{all, 0});
    } else {
        at->range = all;
        spans_.erase(at + 1, spans_.begin() + static_cast<std::ptrdiff_t>(end));
    }
    std::int64_t before = begin == 0 ? 0 : spans_[begin - 1].before + spans_[begin - 1].range.count();
    for (std::size_t i = begin; i < spans_.size() && (i == begin || spans_[i].before != before); ++i) {
        spans_[i].before = before;
        before += spans_[i].range.count();
    }
}

void BlockRanges::add(const BlockRanges& others) {
    if (others.spans_.size() < 2 || (!empty() && back() < others.front())) {
        for (const Span& span : others.spans_) add(span.range);
        return;
    }
    // Both are in order, so each range is added at the end.
    BlockRanges all;
    auto own = spans_.begin();
    for (const Span& span : others.spans_) {
        for (; own != spans_.end() && own->range.first <= span.range.first; ++own) all.add(own->range);
        all.add(span.range);
    }
    for (; own != spans_.end(); ++own) all.add(own->range);
    *this = std::move(all);
}

BlockRanges BlockRanges::without(const BlockRanges& others) const {
    BlockRanges rest;
    for (const Span& span : spans_) {
        std::int64_t first = span.range.first;
        for (std::size_t i = others.span_at(first); i < others.spans_.size() && first <= span.range.last; ++i) {
            const BlockRange& gone = others.spans_[i].range;
            if (gone.first > span.range.last) break;
            if (first < gone.first) rest.add(BlockRange{first, gone.first - 1});
            first = gone.last + 1;
        }
        if (first <= span.range.last) rest.add(BlockRange{first, span.range.last});
    }
    return rest;
}

}  // namespace credence
