#include "files/journal/journal.hpp"

#include <credence/error.hpp>

#include <algorithm>

namespace credence {

Journal::Journal(const std::string& path, mode_t mode) : file_(path, mode) {
    const std::optional<FoundHeader> found = find_header(file_);
    if (!found) return;
    header_ = found->header;
    header_size_ = found->size;
    asked_ = header_->trials;
    const std::string bytes = file_.read(0, header_size_);
    seal_ = checksum(bytes.data(), bytes.size());
}

void Journal::begin(const JournalHeader& header, Study& study) {
    keep(study);
    file_.cut(0);
    const std::string bytes = header_bytes(header);
    file_.append({bytes});
    header_size_ = static_cast<std::int64_t>(bytes.size());
    seal_ = checksum(bytes.data(), bytes.size());
    sync_folder(folder_of(file_.path()), file_.path());
    header_ = header;
    header_size_ = file_.size();
    asked_ = header.trials;
    finished(study);
}

void Journal::take_back(std::size_t scenario, std::int64_t block) {
    PlacedBlocks& placed = kept_[scenario].placed;
    kept_[scenario].counted -= placed.trials_of(block);
    placed.remove(block);
}

void Journal::take(std::size_t scenario, const Block& block) {
    Kept& kept = kept_[scenario];
    const std::size_t before = kept.pending_values.size();
    kept.pending.push_back(block.index);
    kept.pending_values.reserve(static_cast<std::size_t>(kept.layout.size({block.index, block.trials})));
    put_block(kept.pending_values, kept.types, block);
    pending_size_ += kept.pending_values.size() - before;
    ++pending_blocks_;
}

namespace {

constexpr std::size_t too_much = std::size_t{64} << 20;

}  // namespace

bool Journal::full() const { return committing_ && pending_size_ > too_much; }

bool Journal::due(std::int64_t held) const {
    using Seconds = std::chrono::duration<double>;
    constexpr Seconds least(0.5), most(10.0);
    if (committing_) return false;
    if (pending_size_ + static_cast<std::size_t>(held) > too_much) return true;
    if (commit_every_ > 0) return pending_blocks_ >= static_cast<std::size_t>(commit_every_);
    // Totals are as large after one block as after a thousand, so they should not make up most of the journal. Where
    // they would make up all of it, the interval between commits grows with the run: at most a hundredth of the run's
    // time so far can be lost, and the number of commits hardly grows with that time.
    const Seconds waited = std::chrono::steady_clock::now() - last_commit_,
                  longest = keeps_trials() ? most : std::max(most, Seconds(last_commit_ - begun_) / 100);
    return waited > least && (pending_size_ > totals_size_ / 4 || waited > longest);
}

void Journal::put_commit(std::size_t scenario, const Study& study) {
    Kept& kept = kept_[scenario];
    ByteWriter totals;
    put_totals(totals, *WithTotals(study.scenarios[scenario]));
    const Keep keep = kept.layout.keep();
    CommitStart start = commit_of(kept.pending, study.trials, kept.layout);
    const std::size_t before = commit_head_size + commit_start_size + block_list_size(start, keep);
    std::int64_t position = file_.size() + batch_size_ + static_cast<std::int64_t>(before);
    for (const JournalBlock& block : start.blocks) {
        kept.placed.put(block.index, {block.trials, position, false});
        position += kept.layout.size(block);
    }
    kept.totals = {position, static_cast<std::int64_t>(totals.size())};
    for (const BlockRange& range : start.ranges) kept.placed.put(range, study.trials, kept.layout);
    for (const std::int64_t block : kept.pending) kept.counted += trials_in_block(study.trials, block);
    start.counted = kept.counted;
    start.shard = shard_;
    start.release = release_;
    note_release(computed_by_, release_);
    totals_size_ += totals.size();
    // Moved out: values are large, and a string that is only cleared would keep its capacity, one for every scenario.
    batch_.push_back({commit_start_bytes(static_cast<std::uint32_t>(scenario), start, keep,
                                         kept.pending_values.size() + totals.size()),
                      kept.pending_values.take(), totals.take()});
    batch_size_ += batch_.back().size() + static_cast<std::int64_t>(commit_tail_size);
    kept.pending.clear();
}

void Journal::prepare(const Study& study) {
    totals_size_ = 0;
    for (std::size_t s = 0; s < kept_.size(); ++s)
        if (!kept_[s].pending.empty()) put_commit(s, study);
    if (batch_.empty() && study.trials > asked_) put_commit(0, study);  // commits the number without blocks
    asked_ = std::max(asked_, study.trials);
    pending_size_ = pending_blocks_ = 0;
    last_commit_ = std::chrono::steady_clock::now();
    committing_ = true;
}

void Journal::commit() {
    std::vector<std::string> pieces;
    for (PreparedCommit& record : batch_) {
        std::uint32_t crc = 0;
        for (std::string* piece : {&record.start, &record.values, &record.totals}) {
            crc = checksum(piece->data(), piece->size(), crc);
            pieces.push_back(std::move(*piece));
        }
        pieces.back().append(reinterpret_cast<const char*>(&crc), sizeof crc);
        seal_ = seal_with(seal_, crc);
    }
    if (!pieces.empty()) file_.append(pieces);
    batch_.clear();
    batch_size_ = 0;
    committing_ = false;
}

void Journal::check_unchanged() const {
    std::int64_t end = 0;
    try {
        const std::string header = file_.read(0, header_size_);
        std::uint32_t seal = checksum(header.data(), header.size());
        end = scan_commits(file_, header_size_, layouts(),
                           [&](const FoundCommit& record) { seal = seal_with(seal, record.checksum); });
        if (end == file_.size() && seal == seal_) return;
    } catch (const BadBytes&) {  // whole commits, but not of this study
    } catch (const InputError& error) {
        if (!file_.is_cut()) throw Failure(error.complaint());  // what the system said
    }
    throw Failure("cannot read back " + file_.path(), "another program changed it, or the disk damaged it",
                  "What is damaged is to be computed again");
}

void Journal::finished(const Study& study) {
    if (!keeps_trials()) return;
    for (std::size_t s = 0; s < kept_.size(); ++s) {
        kept_[s].rows.clear();
        for (const std::int64_t block : study.scenarios[s].blocks)
            kept_[s].rows.push_back(kept_[s].placed.places.at(block));
    }
}

}  // namespace credence
