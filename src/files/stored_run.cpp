#include "files/stored_run.hpp"

#include <credence/error.hpp>

#include "base/wording.hpp"
#include "files/journal/journal.hpp"
#include "files/results/parts.hpp"
#include "files/system/system_file.hpp"
#include "study/block_results.hpp"

#include <algorithm>

namespace credence {

namespace {

std::optional<struct stat> status_of(const std::string& path) { return status_of(path, path, Links::themselves); }

/// Refuses to continue another study, and names the difference.
void check_same_study(const StudyDefinition& there, const StudyDefinition& asked, const std::string& path,
                      const std::string& remedy) {
    const std::string difference = difference_of(there, asked);
    if (!difference.empty()) throw InputError("cannot resume " + path, "it holds another study: " + difference, remedy);
}

/// Whether `whole` has every trial of `part`, which is of the same study.
bool holds(const ScenarioResults& whole, const ScenarioResults& part) {
    if (!part.blocks.without(whole.blocks).empty()) return false;
    if (part.blocks.empty()) return true;
    const auto rows = [&](const ScenarioResults& results) {
        return block_rows(results, static_cast<std::size_t>(*results.blocks.place_of(part.blocks.back())));
    };
    return rows(whole) >= rows(part);
}

bool holds(const Study& whole, const Study& part) {
    return std::equal(whole.scenarios.begin(), whole.scenarios.end(), part.scenarios.begin(), part.scenarios.end(),
                      [](const ScenarioResults& a, const ScenarioResults& b) { return holds(a, b); });
}

std::string ways_out() { return "Give another name, " + as_option("resume") + " or " + as_option("overwrite"); }

/// The file's identity as in a journal's header.
FileIdentity without_device(FileIdentity file) {
    file.device = 0;
    return file;
}

}  // namespace

std::string journal_path_of(const std::string& path) { return Output(path).target + ".journal"; }

StudyDefinition stored_definition(const std::string& path) {
    if (const std::string beside = journal_path_of(path); status_of(beside)) {
        const Journal journal(beside);
        if (journal.header()) return journal.header()->study;
    }
    return definition_of(read_results_without_totals(path).study);
}

StoredRun::Contents StoredRun::Contents::of(const Study& study) {
    Contents contents{study.trials, {}};
    for (const ScenarioResults& results : study.scenarios) contents.blocks.push_back(results.blocks);
    return contents;
}

StoredRun::StoredRun(const std::string& path, Study study, Start start, const std::string& release)
    : output_(check_output(path, start != Start::fresh, ways_out())),
      journal_path_(journal_path_of(path)),
      start_(start),
      release_(release.substr(0, commit_release_size)),  // cut as in a journal
      study_(std::move(study)) {
    refuse_clashing_links(study_);
    open_journal();
    if (start_ == Start::resume) resume();
}

StoredRun::StoredRun(StoredRun&&) noexcept = default;

StoredRun::~StoredRun() = default;

void StoredRun::open_journal() {
    const std::optional<struct stat> status = status_of(journal_path_);
    if (!status) return;
    if (!S_ISREG(status->st_mode))
        throw InputError("cannot write " + output_.path, journal_path_ + " is in the way of its journal",
                         "Remove that, or give another name");
    if (start_ == Start::fresh)
        throw InputError("cannot write " + output_.path, "an interrupted run left " + journal_path_, ways_out());
    if (start_ == Start::resume) journal_ = std::make_unique<Journal>(journal_path_);
}

void StoredRun::resume() {
    const StudyDefinition asked = definition_of(study_);
    if (journal_ && journal_->header()) resume_journal(*journal_->header(), asked);
    else if (output_.there) read_file(asked);
    check_releases();
}

void StoredRun::resume_journal(const JournalHeader& header, const StudyDefinition& asked) {
    check_same_study(header.study, asked, journal_path_,
                     "Finish that study first, remove the journal if it is not to be finished, or name another output");
    if (header.base != JournalBase::grown) {
        // A file that --overwrite replaces does not affect the run.
        const bool unexpected = output_.there && !(header.base == JournalBase::replaced && is_base_of(header));
        return unexpected ? choose(asked) : journal_->load(study_);
    }
    if (!output_.there)
        throw InputError("cannot resume " + journal_path_, output_.path + ", which it extends, is gone",
                         "Put that back, or remove the journal and start anew");
    read_file(asked);
    try {
        journal_->load(study_);
    } catch (const InputError&) {
        if (is_base_of(header)) throw;
        throw InputError("cannot resume " + journal_path_, output_.path + " is not the file that it extends",
                         "Put that back, or remove the journal to resume " + output_.path + " as it is");
    }
}

/// There are a journal and a results file that the journal does not know: either its run wrote the file and died before
/// it removed the journal, or a merge wrote it.
void StoredRun::choose(const StudyDefinition& asked) {
    Study in_file = stored(asked);
    journal_->load(study_);
    if (holds(in_file, study_)) {
        study_ = std::move(in_file);
        in_file_ = Contents::of(study_);
        journal_is_over_ = true;
    } else if (!holds(study_, in_file)) {
        throw InputError("cannot resume " + output_.path,
                         "it and " + journal_path_ + " each have trials that the other lacks",
                         "Move it away, " + as_option("resume") + ", and merge both");
    }
}

Study StoredRun::stored(const StudyDefinition& asked) const {
    Study study = read_results(output_.target, most_totals_in_memory).study;
    check_same_study(
        definition_of(study), asked, output_.path,
        journal_ && journal_->header() ? "Move it away to resume " + journal_path_ : "Name another output");
    require_all_columns(study, "cannot resume " + output_.path);
    return study;
}

void StoredRun::read_file(const StudyDefinition& asked) {
    study_ = stored(asked);
    if (study_.computed_by.empty()) study_.computed_by = {unknown_release};
    in_file_ = Contents::of(study_);
}

/// Whether the file is the one that existed when the journal was begun.
bool StoredRun::is_base_of(const JournalHeader& header) const {
    return output_.there && without_device(*output_.there) == header.base_file;
}

void StoredRun::check_releases() const {
    const std::string other = unmixable(study_.computed_by, release_);
    if (!other.empty())
        throw InputError("cannot resume " + output_.path, why_unmixable(other, release_),
                         "Go on with that release, or name another output");
}

BlockKeeper& StoredRun::begin(std::int64_t trials, std::int64_t commit_every, const Shard& shard) {
    const bool goes_on = journal_ && journal_->header() && !journal_is_over_;
    // If other users may not read the results file, they may not read its journal either.
    if (!journal_) journal_ = std::make_unique<Journal>(journal_path_, permissions_of(output_.target));
    if (!goes_on) {
        if (start_ != Start::overwrite && journal_->header() && !journal_is_over_)
            throw InputError("cannot write " + output_.path, "another run has just begun " + journal_path_,
                             "Let it end, or give another name");
        const JournalBase base = in_file_                     ? JournalBase::grown
                                 : start_ == Start::overwrite ? JournalBase::replaced
                                                              : JournalBase::none;
        const FileIdentity base_file = without_device(output_.there.value_or(FileIdentity{}));
        journal_->begin({base, base_file, std::max(trials, study_.trials), shard, definition_of(study_)}, study_);
        journal_is_over_ = false;
    }
    journal_->commit_every(commit_every);
    journal_->works_on(shard, release_);
    return *journal_;
}

/// Throws Failure where the values that were read back for the results differ from the committed ones.
void StoredRun::check_unchanged() const {
    if (in_file_ && identity_of(output_.target) != output_.there)
        throw Failure("cannot write " + output_.path,
                      "another program changed, replaced or removed it while the run went on with it",
                      "Put back what was there");
    if (journal_) journal_->check_unchanged();
}

void StoredRun::write(const RunFacts& facts) {
    if (journal_) study_.computed_by = journal_->computed_by();
    try {
        write_results(output_, study_, facts, [this] { check_unchanged(); });
    } catch (const InputError& error) {  // the values that were to be read back are damaged
        check_unchanged();
        throw Failure(error.complaint());
    }
}

bool StoredRun::finish(const RunFacts& facts) {
    const bool changed = in_file_ != Contents::of(study_);
    if (changed) write(facts);
    if (journal_) journal_->remove();
    return changed;
}

bool StoredRun::keeps_something() {
    if (in_file_ || (journal_ && journal_->has_commits())) return true;
    try {
        if (journal_) journal_->remove();
    } catch (const Failure&) {  // the earlier error is the one to report
    }
    return false;
}

}  // namespace credence
