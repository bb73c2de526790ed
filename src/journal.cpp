#include "journal.hpp"

#include <credence/error.hpp>

#include "journal_scan.hpp"
#include "journal_totals.hpp"

#include <algorithm>

namespace credence {

namespace {

/// An arm's columns while they are in the journal, in the results file that it grows, or in both.
class ColumnsOfRun : public KeptColumns {
public:
    ColumnsOfRun(const Journal& journal, std::size_t scenario, std::size_t arm)
        : journal_(journal), scenario_(scenario), arm_(arm) {}
    std::vector<double> values(std::size_t column, std::int64_t first, std::int64_t count) const override {
        return journal_.values(scenario_, arm_, column, first, count);
    }

private:
    const Journal& journal_;
    std::size_t scenario_, arm_;
};

}  // namespace

Journal::Journal(const std::string& path) : file_(path) {
    const std::optional<FoundHeader> found = find_header(file_);
    if (!found) return;
    header_ = found->header;
    header_size_ = found->size;
    asked_ = header_->trials;
}

/// From here on the study's columns are read from where the journal has them.
void Journal::keep_columns_of(Study& study) {
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
        ScenarioResults& results = study.scenarios[s];
        Kept kept{BlockLayout(results), {}, {}, {}, results.trials, {}, {}, {}};
        for (const Column& column : results.columns) kept.types.push_back(column.type);
        for (std::size_t place = 0; place < results.blocks.size(); ++place)
            kept.places[results.blocks[place]] = {block_rows(results, place),
                                                  block_size * static_cast<std::int64_t>(place), true};
        for (std::size_t a = 0; a < results.arms.size(); ++a) {
            kept.in_file.push_back(results.arms[a].kept);
            results.arms[a].kept = std::make_shared<ColumnsOfRun>(*this, s, a);
        }
        kept_.push_back(std::move(kept));
    }
}

void Journal::begin(const JournalHeader& header, Study& study) {
    keep_columns_of(study);
    file_.cut(0);
    file_.append(header_bytes(header));
    sync_folder(folder_of(file_.path()), file_.path());
    header_ = header;
    asked_ = header.trials;
    finished(study);
}

void Journal::take_back(std::size_t scenario, std::int64_t block) {
    const auto found = kept_[scenario].places.find(block);
    kept_[scenario].counted -= found->second.trials;
    kept_[scenario].places.erase(found);
}

void Journal::take(std::size_t scenario, const Block& block) {
    Kept& kept = kept_[scenario];
    const auto trials = static_cast<std::size_t>(block.trials);
    const std::size_t before = kept.pending_values.size();
    kept.pending.push_back({block.index, block.trials});
    for (const ArmBlock& arm : block.arms)
        for (std::size_t c = 0; c < kept.types.size(); ++c)
            put_values(kept.pending_values, kept.types[c], arm.columns.data() + c * trials, trials);
    for (const ArmBlock& arm : block.arms) {
        kept.pending_values.put_all(arm.errors);
        kept.pending_values.put_all(arm.nees);
    }
    pending_size_ += kept.pending_values.size() - before;
    ++pending_blocks_;
}

bool Journal::due() const {
    constexpr std::chrono::duration<double> least(0.5), most(10.0);
    constexpr std::size_t too_much = std::size_t{64} << 20;
    if (committing_) return false;
    if (commit_every_ > 0) return pending_blocks_ >= static_cast<std::size_t>(commit_every_);
    // Totals are as large after one block as after a thousand: they are not to make up most of the journal.
    const auto waited = std::chrono::steady_clock::now() - last_commit_;
    return pending_size_ > too_much || (waited > least && (pending_size_ > totals_size_ / 4 || waited > most));
}

void Journal::put_record(std::size_t scenario, const Study& study) {
    Kept& kept = kept_[scenario];
    ByteWriter record, totals;
    put_totals(totals, study.scenarios[scenario]);
    const std::int64_t start = static_cast<std::int64_t>(record_start_size + kept.pending.size() * journal_block_size);
    std::int64_t position = file_.size() + static_cast<std::int64_t>(batch_.size() + record_head_size) + start;
    for (const JournalBlock& block : kept.pending) {
        kept.places[block.index] = {block.trials, position, false};
        kept.counted += block.trials;
        position += kept.layout.size(block);
    }
    put_record_head(record, {static_cast<std::uint32_t>(scenario),
                             start + static_cast<std::int64_t>(kept.pending_values.size() + totals.size())});
    put_record_start(record, {study.trials, kept.counted, kept.pending, shard_});
    record.put_raw(kept.pending_values.bytes().data(), kept.pending_values.size());
    record.put_raw(totals.bytes().data(), totals.size());
    totals_size_ += totals.size();
    batch_ += record.bytes();
    batch_.append(record_tail_size, '\0');
    ends_.push_back(batch_.size());
    kept.pending.clear();
    kept.pending_values = {};
}

void Journal::prepare(const Study& study) {
    totals_size_ = 0;
    for (std::size_t s = 0; s < kept_.size(); ++s)
        if (!kept_[s].pending.empty()) put_record(s, study);
    if (batch_.empty() && study.trials > asked_) put_record(0, study);  // what was asked for is worth a record without blocks
    asked_ = std::max(asked_, study.trials);
    pending_size_ = pending_blocks_ = 0;
    last_commit_ = std::chrono::steady_clock::now();
    committing_ = true;
}

void Journal::commit() {
    std::size_t begin = 0;
    for (const std::size_t end : ends_) {
        const std::size_t size = end - begin - record_tail_size;
        const std::uint32_t crc = checksum(batch_.data() + begin, size);
        std::memcpy(batch_.data() + begin + size, &crc, sizeof crc);
        begin = end;
    }
    if (!batch_.empty()) file_.append(batch_);
    batch_.clear();
    ends_.clear();
    committing_ = false;
}

void Journal::finished(const Study& study) {
    for (std::size_t s = 0; s < kept_.size(); ++s) {
        kept_[s].rows.clear();
        for (const std::int64_t block : study.scenarios[s].blocks) kept_[s].rows.push_back(kept_[s].places.at(block));
    }
}

void Journal::read_values(std::int64_t position, ColumnType type, double* values, std::int64_t count) const {
    std::string bytes(static_cast<std::size_t>(count * value_size(type)), '\0');
    file_.read(position, bytes.data(), bytes.size());
    ByteReader from(bytes.data(), bytes.size());
    try {
        get_values(from, type, values, static_cast<std::size_t>(count));
    } catch (const BadBytes& bad) {
        throw InputError(file_.path() + ": is damaged: holds " + bad.what() + ". Remove it and run the study again.");
    }
}

/// Of `left` rows from row `skip` of block `at` on, those in the results file that can be read there at once: blocks that
/// follow each other here may do so there.
std::int64_t Journal::rows_in_file(const Kept& kept, std::size_t at, std::int64_t skip, std::int64_t left) {
    const BlockPlace& place = kept.rows[at];
    std::int64_t some = std::min(place.trials - skip, left);
    while (some < left && ++at < kept.rows.size()) {
        const BlockPlace& next = kept.rows[at];
        if (!next.in_file || next.position != place.position + skip + some) break;
        some = std::min(some + next.trials, left);
    }
    return some;
}

std::vector<double> Journal::values(std::size_t scenario, std::size_t arm, std::size_t column, std::int64_t first,
                                    std::int64_t count) const {
    const Kept& kept = kept_[scenario];
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (std::int64_t row = first, some = 0; row < first + count; row += some) {
        const auto at = static_cast<std::size_t>(row / block_size);
        const BlockPlace& place = kept.rows[at];
        const std::int64_t skip = row % block_size, left = first + count - row;
        if (place.in_file) {
            some = rows_in_file(kept, at, skip, left);
            const std::vector<double> read = kept.in_file[arm]->values(column, place.position + skip, some);
            values.insert(values.end(), read.begin(), read.end());
        } else {
            some = std::min(place.trials - skip, left);
            values.resize(values.size() + static_cast<std::size_t>(some));
            const ColumnType type = kept.types[column];
            read_values(place.position + kept.layout.column_offset(arm, column, place.trials) + skip * value_size(type),
                        type, values.data() + values.size() - some, some);
        }
    }
    return values;
}

}  // namespace credence
