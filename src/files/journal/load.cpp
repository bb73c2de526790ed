// Reading a journal back: its committed blocks and the totals over them.

#include "files/journal/journal.hpp"

#include <credence/error.hpp>

#include <algorithm>

namespace credence {

std::vector<BlockLayout> Journal::layouts() const {
    std::vector<BlockLayout> layouts;
    for (const Kept& kept : kept_) layouts.push_back(kept.layout);
    return layouts;
}

/// Reads all commits up to a torn one, which is cut together with everything after it.
std::vector<JournalScenario> Journal::scan(const Study& study) {
    std::vector<JournalScenario> found(study.scenarios.size());
    const std::vector<BlockLayout> layouts = this->layouts();
    const std::int64_t end = scan_commits(file_, header_size_, layouts, [&](const FoundCommit& record) {
        seal_ = seal_with(seal_, record.checksum);
        found[record.scenario].take(record, layouts[record.scenario]);
        note_release(computed_by_, record.start.release);
        asked_ = std::max(asked_, record.start.trials);
    });
    torn_ = file_.size() - end;
    file_.cut(end);
    return found;
}

/// Errors and NEES of the blocks that have details and are in the journal.
void Journal::read_details(std::size_t scenario, ScenarioResults& results) const {
    const Kept& kept = kept_[scenario];
    for (std::size_t at = 0; at < results.blocks.size() && kept.layout.detailed(results.blocks[at]); ++at) {
        const BlockPlace& place = kept.placed.places.at(results.blocks[at]);
        if (place.in_file) continue;
        const std::int64_t row = block_size * static_cast<std::int64_t>(at);
        for (std::size_t a = 0; a < results.arms.size(); ++a) {
            const std::string bytes = file_.read(place.position + kept.layout.details_offset(a, place.trials),
                                               kept.layout.details_size(place.trials));
            ByteReader from(bytes.data(), bytes.size());
            get_details(from, kept.layout, place.trials, row, results.arms[a]);
        }
    }
}

void Journal::load_totals(std::size_t scenario, ScenarioResults& results) const {
    const Kept& kept = kept_[scenario];
    if (kept.totals_in_file) (*kept.totals_in_file)(results);
    if (!kept.totals.found()) return;
    set_blocks(results, kept.placed.blocks, kept.placed.trials_up_to());
    const std::string bytes = file_.read(kept.totals.position, kept.totals.size);
    try {
        ByteReader totals(bytes.data(), bytes.size());
        get_totals(totals, results, kept.counted);
        read_details(scenario, results);
    } catch (const BadBytes& bad) {
        refuse_damaged(file_.path(), bad.what());
    }
}

void Journal::load(Study& study) {
    keep(study);
    TotalsInMemory in_memory(most_totals_in_memory);
    try {
        const std::vector<JournalScenario> found = scan(study);
        for (std::size_t s = 0; s < found.size(); ++s) {
            PlacedBlocks& placed = kept_[s].placed;
            if (!add_places(placed, found[s])) continue;
            ScenarioResults& results = study.scenarios[s];
            kept_[s].counted = found[s].counted;
            kept_[s].totals = found[s].totals;
            drop_totals(results);
            set_blocks(results, placed.blocks, placed.trials_up_to());
            credence::load_totals(results);
            in_memory.limit(results);
        }
    } catch (const BadBytes& bad) {
        refuse_damaged(file_.path(), bad.what());
    }
    study.trials = std::max(study.trials, asked_);
    study.complete = std::ranges::all_of(
        study.scenarios, [&](const ScenarioResults& results) { return results.trials == study.trials; });
    study.computed_by = computed_by_;
    finished(study);
}

}  // namespace credence
