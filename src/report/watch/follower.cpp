#include "report/watch/follower.hpp"

#include <credence/error.hpp>
#include <credence/detail/store.hpp>

#include <algorithm>

namespace credence {

JournalFollower::JournalFollower(const JournalBytes& journal, const FoundHeader& found, const std::string& results)
    : study_(new_study(found.header.study.scenarios, found.header.study.root_seed, found.header.study.keep)),
      followed_(study_.scenarios.size()),
      start_(journal.read(0, found.size)),
      position_(found.size),
      shard_(found.header.shard) {
    study_.trials = found.header.trials;
    for (ScenarioResults& scenario : study_.scenarios) {
        layouts_.emplace_back(scenario);
        for (ArmResults& arm : scenario.arms) arm.columns = {};  // no trial is read
    }
    seal_ = seal_of(journal);
    if (found.header.base == JournalBase::grown) read_file(results, found.header.study);
}

void JournalFollower::read_file(const std::string& path, const StudyDefinition& expected) {
    const Study stored = read_results(path, 0).study;
    const std::string difference = difference_of(definition_of(stored), expected);
    if (!difference.empty())
        throw InputError("is not the file that its journal extends", difference,
                         "Put that back, or remove the journal")
            .at(path);
    for (std::size_t s = 0; s < followed_.size(); ++s) {
        ScenarioResults& results = study_.scenarios[s];
        const ScenarioResults& from = stored.scenarios[s];
        followed_[s].in_file = places_in_file(from, layouts_[s]);
        results.blocks = from.blocks;
        results.trials = from.trials;
        for (std::size_t a = 0; a < results.arms.size(); ++a)
            results.arms[a].totals.trials = from.arms[a].totals.trials;
    }
}

std::string JournalFollower::seal_of(const JournalBytes& journal) const {
    return journal.read(position_ - static_cast<std::int64_t>(commit_tail_size), commit_tail_size);
}

bool JournalFollower::goes_on_with(const JournalBytes& journal) const {
    // Before the first commit a run's journal cannot be distinguished from that of the next run.
    const auto header_end = static_cast<std::int64_t>(start_.size());
    return position_ > header_end && journal.size() >= position_ && journal.read(0, header_end) == start_ &&
           seal_of(journal) == seal_;
}

/// Reads the last totals of a scenario, unless they were read before or the results file has them.
void JournalFollower::read_totals(const JournalBytes& journal, std::size_t scenario) {
    Followed& followed = followed_[scenario];
    const JournalTotals& totals = followed.in_journal.totals;
    if (totals.position == followed.read) return;
    followed.read = totals.position;
    PlacedBlocks placed = followed.in_file;
    if (!add_places(placed, followed.in_journal)) return;
    ScenarioResults& results = study_.scenarios[scenario];
    const std::string bytes = journal.read(totals.position, totals.size);
    ByteReader from(bytes.data(), bytes.size());
    clear_totals(results);
    get_totals(from, results, followed.in_journal.counted);
    drop_totals(results);  // those of trials are kept
    set_blocks(results, placed.blocks, placed.trials_up_to());
}

void JournalFollower::read(const JournalBytes& journal) {
    position_ = scan_commits(journal, position_, layouts_, [&](const FoundCommit& commit) {
        followed_[commit.scenario].in_journal.take(commit, layouts_[commit.scenario]);
        study_.trials = std::max(study_.trials, commit.start.trials);
        shard_ = commit.start.shard;
    });
    seal_ = seal_of(journal);
    for (std::size_t s = 0; s < followed_.size(); ++s) read_totals(journal, s);
}

}  // namespace credence
