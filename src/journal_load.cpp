// Reading a journal back: which blocks were committed, and the totals over them.

#include "journal.hpp"

#include <credence/error.hpp>

#include "journal_scan.hpp"
#include "journal_totals.hpp"

#include <algorithm>

namespace credence {

/// Reads all records up to a torn one, which is cut with what is behind it.
std::vector<JournalScenario> Journal::scan(const Study& study) {
    std::vector<JournalScenario> found(study.scenarios.size());
    std::vector<BlockLayout> layouts;
    for (const Kept& kept : kept_) layouts.push_back(kept.layout);
    const std::int64_t end = scan_records(file_, header_size_, layouts, [&](const FoundRecord& record) {
        JournalScenario& scenario = found[record.scenario];
        for (std::size_t b = 0; b < record.places.size(); ++b)
            scenario.places[record.start.blocks[b].index] = {record.start.blocks[b].trials, record.places[b], false};
        scenario.asked = record.start.trials;
        scenario.counted = record.start.counted;
        scenario.totals = file_.read(record.totals, record.end - record.totals);
        asked_ = std::max(asked_, record.start.trials);
    });
    torn_ = file_.size() - end;
    file_.cut(end);
    return found;
}

/// Errors and NEES of the blocks that have them and are in the journal.
void Journal::read_details(std::size_t scenario, ScenarioResults& results) const {
    const Kept& kept = kept_[scenario];
    for (std::size_t at = 0; at < results.blocks.size() && kept.layout.detailed(results.blocks[at]); ++at) {
        const BlockPlace& place = kept.places.at(results.blocks[at]);
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

/// Whether the results file holds all that the journal has of a scenario: the run had ended, and only the journal had
/// still to go.
bool already_in_file(const std::map<std::int64_t, BlockPlace>& in_file, const JournalScenario& found) {
    return std::all_of(found.places.begin(), found.places.end(), [&](const auto& entry) {
        const auto there = in_file.find(entry.first);
        return there != in_file.end() && there->second.trials == entry.second.trials;
    });
}

/// Adds the journal's blocks to those of the file. A partial one that the study of the last totals has larger had been
/// taken back before, and is left out. Throws BadBytes where blocks and totals do not agree.
void add_places(std::map<std::int64_t, BlockPlace>& places, const JournalScenario& found) {
    for (const auto& [index, place] : found.places) places[index] = place;
    std::erase_if(places, [&](const auto& entry) {
        return entry.second.trials < trials_in_block(found.asked, entry.first);
    });
    std::int64_t trials = 0;
    for (const auto& [index, place] : places) trials += place.trials;
    if (trials != found.counted) throw BadBytes("totals and blocks do not agree");
    for (const auto& [index, place] : places)
        if (place.trials != block_size && index != places.rbegin()->first)
            throw BadBytes("a partial block is not the last");
}

/// The study that has just these blocks.
std::int64_t trials_up_to(const std::map<std::int64_t, BlockPlace>& places) {
    return places.empty() ? 0 : places.rbegin()->first * block_size + places.rbegin()->second.trials;
}

}  // namespace

void Journal::load(Study& study) {
    keep_columns_of(study);
    try {
        const std::vector<JournalScenario> found = scan(study);
        for (std::size_t s = 0; s < found.size(); ++s) {
            if (!found[s].totals || already_in_file(kept_[s].places, found[s])) continue;
            ScenarioResults& results = study.scenarios[s];
            add_places(kept_[s].places, found[s]);
            kept_[s].counted = found[s].counted;
            std::vector<std::int64_t> blocks;
            for (const auto& [index, place] : kept_[s].places) blocks.push_back(index);
            set_blocks(results, std::move(blocks), trials_up_to(kept_[s].places));
            ByteReader totals(found[s].totals->data(), found[s].totals->size());
            get_totals(totals, results);
            for (const ArmResults& arm : results.arms)
                if (arm.counted < 0 || arm.counted > found[s].counted)
                    throw BadBytes("totals of an impossible number of trials");
            read_details(s, results);
        }
    } catch (const BadBytes& bad) {
        refuse_damaged(file_.path(), bad.what());
    }
    study.trials = std::max(study.trials, asked_);
    study.complete = std::all_of(study.scenarios.begin(), study.scenarios.end(), [&](const ScenarioResults& results) {
        return results.trials == study.trials;
    });
    finished(study);
}

}  // namespace credence
