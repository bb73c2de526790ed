// Reading a journal back: its committed blocks and the totals over them.

#include "files/journal/journal.hpp"

#include <credence/error.hpp>

#include "files/journal/scan.hpp"
#include "files/journal/totals.hpp"

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
        JournalScenario& scenario = found[record.scenario];
        for (std::size_t b = 0; b < record.places.size(); ++b)
            scenario.placed.put(record.start.blocks[b].index,
                                {record.start.blocks[b].trials, record.places[b], false});
        for (const BlockRange& range : record.start.ranges)
            scenario.placed.put(range, record.start.trials, layouts[record.scenario]);
        note_release(computed_by_, record.start.release);
        scenario.asked = record.start.trials;
        scenario.counted = record.start.counted;
        scenario.totals = {record.totals, record.end - record.totals};
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

namespace {

/// Adds the journal's blocks to those of the file. A partial block that is larger in the study of the last totals had
/// been removed from the totals before, and is left out. Throws BadBytes where blocks and totals do not agree.
void add_places(PlacedBlocks& placed, const JournalScenario& found) {
    placed.put(found.placed);
    std::vector<std::int64_t> taken_back;
    for (const auto& [block, place] : placed.places)
        if (place.trials < trials_in_block(found.asked, block)) taken_back.push_back(block);
    for (const std::int64_t block : taken_back) placed.remove(block);
    if (placed.trials() != found.counted) throw BadBytes("totals and blocks do not agree");
    for (const auto& [block, place] : placed.places)
        if (place.trials != block_size && block != placed.blocks.back())
            throw BadBytes("a partial block is not the last");
}

}  // namespace

void Journal::load_totals(std::size_t scenario, ScenarioResults& results) const {
    const Kept& kept = kept_[scenario];
    if (kept.totals_in_file) kept.totals_in_file->load(results);
    if (!kept.totals.found()) return;
    set_blocks(results, kept.placed.blocks, kept.placed.trials_up_to());
    const std::string bytes = file_.read(kept.totals.position, kept.totals.size);
    try {
        ByteReader totals(bytes.data(), bytes.size());
        get_totals(totals, results);
        for (const ArmResults& arm : results.arms)
            if (arm.totals.trials.trials() != kept.counted)
                throw BadBytes("totals of an impossible number of trials");
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
            // The run may have ended, so that the results file holds everything and only the journal's removal was
            // missing.
            if (!found[s].totals.found() || placed.has(found[s].placed)) continue;
            ScenarioResults& results = study.scenarios[s];
            add_places(placed, found[s]);
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
    study.complete = std::all_of(study.scenarios.begin(), study.scenarios.end(), [&](const ScenarioResults& results) {
        return results.trials == study.trials;
    });
    study.computed_by = computed_by_;
    finished(study);
}

}  // namespace credence
