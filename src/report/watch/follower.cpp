#include "report/watch/follower.hpp"

#include <credence/error.hpp>
#include <credence/detail/store.hpp>

#include "files/journal/totals.hpp"

#include <algorithm>

namespace credence {

std::vector<std::size_t> watched_columns(const std::vector<Column>& columns) {
    std::vector<std::size_t> watched;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (is_reported(columns[c]) && columns[c].name != "mean_trace_P") watched.push_back(c);
    return watched;
}

WatchedScenario described(const ScenarioResults& results) {
    WatchedScenario scenario;
    scenario.name = results.scenario.name;
    const std::vector<std::size_t> watched = watched_columns(results.columns);
    for (const std::size_t column : watched) scenario.columns.push_back(results.columns[column]);
    for (const ArmResults& of_arm : results.arms) {
        const TrialTotals& totals = of_arm.totals.trials;
        WatchedArm arm{of_arm.name, totals.trials() - totals.counted(),
                       totals.statuses[static_cast<std::size_t>(Status::diverged)], {}, {}, {}};
        for (const std::size_t column : watched) arm.columns.push_back(column_moments(of_arm, column));
        if (const ArmResults* other = baseline_of(results, of_arm)) {
            arm.other = other->name;
            arm.difference = moments_of(column_differences(results, of_arm, *other, watched.front()).difference);
        }
        scenario.arms.push_back(std::move(arm));
    }
    return scenario;
}

JournalFollower::JournalFollower(const JournalBytes& journal, FoundHeader found, const std::string& results)
    : header_(std::move(found.header)),
      study_(new_study(header_.study.scenarios, header_.study.root_seed, header_.study.keep)),
      followed_(study_.scenarios.size()),
      start_(journal.read(0, found.size)),
      position_(found.size),
      asked_(header_.trials),
      shard_(header_.shard) {
    for (const ScenarioResults& scenario : study_.scenarios) layouts_.emplace_back(scenario);
    seal_ = seal_of(journal);
    if (header_.base == JournalBase::grown) read_file(results);
}

void JournalFollower::read_file(const std::string& path) {
    const Study stored = read_results(path, 0).study;
    const std::string difference = difference_of(definition_of(stored), header_.study);
    if (!difference.empty())
        throw InputError(path + ": is not the file that its journal goes on with (" + difference +
                         "). Put that back, or remove the journal.");
    for (std::size_t s = 0; s < followed_.size(); ++s) {
        followed_[s].in_file = blocks_of(stored.scenarios[s]);
        for (std::size_t a = 0; a < study_.scenarios[s].arms.size(); ++a)  // until the journal has others
            study_.scenarios[s].arms[a].totals.trials = stored.scenarios[s].arms[a].totals.trials;
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

void JournalFollower::take(const JournalBytes& journal, const FoundCommit& record) {
    Followed& followed = followed_[record.scenario];
    for (const BlockRange& range : record.start.ranges) followed.in_journal.add(range, record.start.trials);
    if (header_.study.keep == Keep::trials)
        for (const JournalBlock& block : record.start.blocks)
            followed.in_journal.add({block.index, block.index}, record.start.trials);
    followed.in_file.asked(record.start.trials);
    followed.in_journal.asked(record.start.trials);
    followed.counted = record.start.counted;
    followed.totals = journal.read(record.totals, record.end - record.totals);
    asked_ = std::max(asked_, record.start.trials);
    shard_ = record.start.shard;
}

/// Takes the last totals of a scenario, and checks that they are of the blocks that are there.
void JournalFollower::check(std::size_t scenario) {
    Followed& followed = followed_[scenario];
    if (!followed.totals) return;
    ScenarioResults& results = study_.scenarios[scenario];
    ByteReader from(followed.totals->data(), followed.totals->size());
    load_totals(results);
    get_totals(from, results);
    drop_totals(results);  // those of trials are kept
    followed.totals.reset();
    if (followed.already_in_file()) return;
    if (followed.trials() != followed.counted) throw BadBytes("totals and blocks do not agree");
    for (const ArmResults& arm : results.arms)
        if (arm.totals.trials.trials() != followed.counted)
            throw BadBytes("totals of an impossible number of trials");
}

void JournalFollower::read(const JournalBytes& journal) {
    position_ = scan_commits(journal, position_, layouts_, [&](const FoundCommit& record) { take(journal, record); });
    seal_ = seal_of(journal);
    for (std::size_t s = 0; s < followed_.size(); ++s) check(s);
}

void JournalFollower::tell(Snapshot& snapshot) const {
    snapshot.state = RunState::running;
    snapshot.trials = asked_;
    snapshot.shard = shard_;
    for (std::size_t s = 0; s < followed_.size(); ++s) {
        const Followed& followed = followed_[s];
        WatchedScenario scenario = described(study_.scenarios[s]);
        const bool in_file = followed.already_in_file();
        const auto over_both = [&](auto count) {
            return count(followed.in_file) + (in_file ? 0 : count(followed.in_journal));
        };
        scenario.trials = over_both([](const WatchedBlocks& part) { return part.trials(); });
        scenario.blocks = over_both([](const WatchedBlocks& part) { return part.blocks(); });
        // Blocks that are present already, and those that the shard lacks.
        scenario.trials_asked = scenario.trials + trials_of_shard(shard_, asked_) -
                                over_both([&](const WatchedBlocks& part) { return part.trials_of(shard_); });
        scenario.blocks_asked = scenario.blocks + blocks_of_shard(shard_, asked_) -
                                over_both([&](const WatchedBlocks& part) { return part.blocks_of(shard_); });
        snapshot.scenarios.push_back(std::move(scenario));
    }
}

}  // namespace credence
