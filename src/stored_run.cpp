#include <credence/stored_run.hpp>

#include <credence/error.hpp>

#include "journal.hpp"

#include <algorithm>
#include <filesystem>

namespace credence {

namespace {

bool exists(const std::string& path) {
    std::error_code none;
    return std::filesystem::exists(std::filesystem::symlink_status(path, none));
}

/// Refuses to go on with another study, saying what differs.
void check_same_study(const StudyDefinition& there, const StudyDefinition& asked, const std::string& path) {
    const std::string difference = difference_of(there, asked);
    if (!difference.empty())
        throw InputError("cannot resume " + path + " (it holds another study: " + difference +
                         "). Name another output.");
}

}  // namespace

StoredRun::Contents StoredRun::Contents::of(const Study& study) {
    Contents contents{study.trials, {}};
    for (const ScenarioResults& results : study.scenarios) contents.blocks.push_back(results.blocks);
    return contents;
}

StoredRun::StoredRun(const std::string& path, Study study, Start start)
    : path_(path), journal_path_(path + ".journal"), start_(start), study_(std::move(study)) {
    check_output(path_, start_ != Start::fresh, "Give another name, --resume or --overwrite");
    if (exists(journal_path_)) open_journal();
    if (start_ == Start::resume) go_on();
}

StoredRun::StoredRun(StoredRun&&) noexcept = default;

StoredRun::~StoredRun() = default;

void StoredRun::open_journal() {
    std::error_code none;
    if (!std::filesystem::is_regular_file(journal_path_, none))
        throw InputError("cannot write " + path_ + " (" + journal_path_ +
                         " is in the way of its journal). Remove that, or give another name.");
    if (start_ == Start::fresh)
        throw InputError("cannot write " + path_ + " (an interrupted run left " + journal_path_ +
                         "). Give another name, --resume or --overwrite.");
    if (start_ == Start::resume) journal_ = std::make_unique<Journal>(journal_path_);
}

void StoredRun::go_on() {
    const StudyDefinition asked = definition_of(study_);
    const std::optional<JournalHeader> header = journal_ ? journal_->header() : std::nullopt;
    if (header) check_same_study(header->study, asked, journal_path_);
    const bool grown = !header || header->base == JournalBase::grown;
    if (header && grown && !exists(path_))
        throw InputError("cannot resume " + journal_path_ + " (" + path_ +
                         ", which it goes on with, is gone). Put that back, or remove the journal and start anew.");
    // A file that --overwrite is to replace says nothing to the run. One that a run without a file made must be its own.
    if (exists(path_) && (!header || header->base != JournalBase::replaced)) {
        Study stored = read_results(path_).study;
        check_same_study(definition_of(stored), asked, path_);
        if (grown) {
            study_ = std::move(stored);
            in_file_ = Contents::of(study_);
        }
    }
    if (header) journal_->load(study_);
}

BlockKeeper& StoredRun::begin(std::int64_t trials, std::int64_t commit_every, const Shard& shard) {
    const bool goes_on = journal_ && journal_->header();
    if (!journal_) journal_ = std::make_unique<Journal>(journal_path_);
    if (!goes_on) {
        if (start_ != Start::overwrite && journal_->header())
            throw InputError("cannot write " + path_ + " (another run has just begun " + journal_path_ +
                             "). Let it end, or give another name.");
        const JournalBase base = in_file_                     ? JournalBase::grown
                                 : start_ == Start::overwrite ? JournalBase::replaced
                                                              : JournalBase::none;
        journal_->begin({base, std::max(trials, study_.trials), shard, definition_of(study_)}, study_);
    }
    journal_->commit_every(commit_every);
    journal_->works_on(shard);
    return *journal_;
}

bool StoredRun::finish(const RunFacts& facts) {
    const bool changed = in_file_ != Contents::of(study_);
    if (changed) write_results(path_, study_, facts);
    if (journal_) journal_->remove();
    return changed;
}

}  // namespace credence
