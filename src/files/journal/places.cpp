// The blocks of a journal and their places.

#include "files/journal/journal.hpp"

#include <algorithm>

namespace credence {

void PlacedBlocks::put(std::int64_t block, const BlockPlace& place) {
    blocks.add(block);
    places[block] = place;
}

void PlacedBlocks::put(const BlockRange& range, std::int64_t trials, const BlockLayout& layout) {
    blocks.add(range);
    // A block that was partial may be complete now.
    for (auto at = places.lower_bound(std::max(range.first, layout.detailed_blocks()));
         at != places.end() && at->first <= range.last;)
        at = places.erase(at);
    const std::int64_t of_last = trials_in_block(trials, range.last);
    if (of_last < block_size && !layout.detailed(range.last)) places[range.last] = {of_last, 0, false};
}

void PlacedBlocks::put(const PlacedBlocks& others) {
    blocks.add(others.blocks);
    std::erase_if(places, [&](const auto& entry) { return others.blocks.contains(entry.first); });
    for (const auto& [block, place] : others.places) places[block] = place;
}

void PlacedBlocks::remove(std::int64_t block) {
    blocks.remove(block);
    places.erase(block);
}

std::int64_t PlacedBlocks::trials_of(std::int64_t block) const {
    const auto found = places.find(block);
    return found == places.end() ? block_size : found->second.trials;
}

std::int64_t PlacedBlocks::trials() const {
    std::int64_t trials = block_size * blocks.count();
    for (const auto& [block, place] : places) trials -= block_size - place.trials;
    return trials;
}

bool PlacedBlocks::has(const PlacedBlocks& others) const {
    const auto as_many = [&](const auto& entry) {
        return !others.blocks.contains(entry.first) || trials_of(entry.first) == others.trials_of(entry.first);
    };
    return others.blocks.without(blocks).empty() && std::all_of(places.begin(), places.end(), as_many) &&
           std::all_of(others.places.begin(), others.places.end(), as_many);
}

}  // namespace credence
