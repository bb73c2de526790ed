// Reading a journal back: which blocks were committed, and the totals over them.

#include "journal.hpp"

#include <credence/error.hpp>

#include "journal_totals.hpp"

#include <algorithm>

namespace credence {

namespace {

[[noreturn]] void damaged(const std::string& path, const std::string& why) {
    throw InputError(path + ": is damaged: " + why + ". Remove it and run the study again, or give an undamaged copy.");
}

/// A record whose checksum is right.
struct FoundRecord {
    std::uint32_t scenario;
    RecordStart start;
    std::int64_t values = 0;  ///< where the blocks' values begin in the file
    std::int64_t end = 0;     ///< of the payload
};

std::string bytes_at(const JournalFile& file, std::int64_t position, std::int64_t size) {
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.read(position, bytes.data(), bytes.size());
    return bytes;
}

/// Whether the file's bytes have the checksum that follows them.
bool checksum_is_right(const JournalFile& file, std::int64_t begin, std::int64_t end) {
    constexpr std::int64_t at_once = std::int64_t{1} << 20;
    std::uint32_t crc = 0, stored = 0;
    for (std::int64_t at = begin; at < end; at += at_once) {
        const std::string some = bytes_at(file, at, std::min(at_once, end - at));
        crc = checksum(some.data(), some.size(), crc);
    }
    file.read(end, &stored, sizeof stored);
    return crc == stored;
}

/// The record that begins at `position`; nothing where it is torn. Throws BadBytes for one that cannot be.
std::optional<FoundRecord> find_record(const JournalFile& file, std::int64_t position) {
    constexpr auto head_size = static_cast<std::int64_t>(record_head_size),
                   tail_size = static_cast<std::int64_t>(record_tail_size);
    const std::int64_t left = file.size() - position - head_size - tail_size;
    if (left < static_cast<std::int64_t>(record_start_size)) return std::nullopt;
    const std::string head_bytes = bytes_at(file, position, head_size);
    RecordHead head;
    try {
        ByteReader from(head_bytes.data(), head_bytes.size());
        head = get_record_head(from);
    } catch (const BadBytes&) {
        return std::nullopt;
    }
    if (head.payload > left) return std::nullopt;
    const std::int64_t payload = position + head_size, end = payload + head.payload;
    if (!checksum_is_right(file, position, end)) return std::nullopt;
    std::uint32_t count = 0;
    file.read(payload + static_cast<std::int64_t>(record_start_size - sizeof count), &count, sizeof count);
    const auto start_size = static_cast<std::int64_t>(record_start_size + count * journal_block_size);
    if (start_size > head.payload) throw BadBytes("a record has more blocks than bytes");
    const std::string start_bytes = bytes_at(file, payload, start_size);
    ByteReader from(start_bytes.data(), start_bytes.size());
    return FoundRecord{head.scenario, get_record_start(from), payload + start_size, end};
}

}  // namespace

/// Reads all records up to a torn one, which is cut with what is behind it.
std::vector<JournalScenario> Journal::scan(const Study& study) {
    std::vector<JournalScenario> found(study.scenarios.size());
    auto position = static_cast<std::int64_t>(header_size_);
    while (const std::optional<FoundRecord> record = find_record(file_, position)) {
        if (record->scenario >= found.size()) throw BadBytes("a record is of a scenario that the study does not have");
        JournalScenario& scenario = found[record->scenario];
        std::int64_t values = record->values;
        for (const JournalBlock& block : record->start.blocks) {
            const std::int64_t size = kept_[record->scenario].layout.size(block);
            if (size > record->end - values) throw BadBytes("a record has fewer values than its blocks");
            scenario.places[block.index] = {block.trials, values, false};
            values += size;
        }
        scenario.asked = record->start.trials;
        scenario.counted = record->start.counted;
        scenario.totals = bytes_at(file_, values, record->end - values);
        asked_ = std::max(asked_, record->start.trials);
        position = record->end + static_cast<std::int64_t>(record_tail_size);
    }
    torn_ = file_.size() - position;
    file_.cut(position);
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
            const std::string bytes = bytes_at(file_, place.position + kept.layout.details_offset(a, place.trials),
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
        damaged(file_.path(), bad.what());
    }
    study.trials = std::max(study.trials, asked_);
    study.complete = std::all_of(study.scenarios.begin(), study.scenarios.end(), [&](const ScenarioResults& results) {
        return results.trials == study.trials;
    });
    finished(study);
}

}  // namespace credence
