#include "files/journal/scan.hpp"

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

void JournalScenario::take(const FoundCommit& commit, const BlockLayout& layout) {
    for (std::size_t b = 0; b < commit.places.size(); ++b)
        placed.put(commit.start.blocks[b].index, {commit.start.blocks[b].trials, commit.places[b], false});
    for (const BlockRange& range : commit.start.ranges) placed.put(range, commit.start.trials, layout);
    asked = commit.start.trials;
    counted = commit.start.counted;
    totals = {commit.totals, commit.end - commit.totals};
}

PlacedBlocks places_in_file(const ScenarioResults& results, const BlockLayout& layout) {
    PlacedBlocks placed{results.blocks, {}};
    const auto note = [&](std::size_t place) {
        placed.places[results.blocks[place]] = {block_rows(results, place),
                                                block_size * static_cast<std::int64_t>(place), true};
    };
    const std::size_t blocks = results.blocks.size();
    const auto with_values = results.keep == Keep::trials ? blocks
                                                          : static_cast<std::size_t>(results.blocks.count_below(
                                                                layout.detailed_blocks()));
    for (std::size_t place = 0; place < with_values; ++place) note(place);
    if (results.trials % block_size != 0) note(blocks - 1);
    return placed;
}

bool add_places(PlacedBlocks& placed, const JournalScenario& found) {
    if (!found.totals.found() || placed.has(found.placed)) return false;
    placed.put(found.placed);
    std::vector<std::int64_t> taken_back;
    for (const auto& [block, place] : placed.places)
        if (place.trials < trials_in_block(found.asked, block)) taken_back.push_back(block);
    for (const std::int64_t block : taken_back) placed.remove(block);
    if (placed.trials() != found.counted) throw BadBytes("totals and blocks do not agree");
    for (const auto& [block, place] : placed.places)
        if (place.trials != block_size && block != placed.blocks.back())
            throw BadBytes("a partial block is not the last");
    return true;
}

}  // namespace credence
