#include "report/watch/follower.hpp"

#include <credence/error.hpp>
#include <credence/detail/store.hpp>

#include "files/journal/totals.hpp"

#include <algorithm>

namespace credence {

WatchedScenario described(const ScenarioResults& results) {
    WatchedScenario scenario;
    scenario.name = results.scenario.name;
    for (const std::size_t index : watched_columns(results.columns)) scenario.columns.push_back(results.columns[index]);
    return scenario;
}

std::vector<WatchedArm> watched_arms(const ScenarioResults& results, const WatchedSums& sums) {
    std::vector<WatchedArm> arms;
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmSums nothing{std::vector<RunningMoments>(watched_columns(results.columns).size()), {}, 0, 0};
        const ArmSums& of_arm = a < sums.arms.size() ? sums.arms[a] : nothing;
        WatchedArm arm{results.arms[a].name, of_arm.failed, of_arm.diverged, {}, {}, of_arm.difference.moments()};
        for (const RunningMoments& column : of_arm.columns) arm.columns.push_back(column.moments());
        if (const ArmResults* fixed = baseline_of(results, results.arms[a])) arm.other = fixed->name;
        arms.push_back(std::move(arm));
    }
    return arms;
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
        for (std::size_t a = 0; a < study_.scenarios[s].arms.size(); ++a)  // until the journal has other counts
            study_.scenarios[s].arms[a].aggregates = stored.scenarios[s].arms[a].aggregates;
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
    const ScenarioResults& results = study_.scenarios[record.scenario];
    const BlockLayout& layout = layouts_[record.scenario];
    for (const BlockRange& range : record.start.ranges) followed.in_journal.add(range, record.start.trials);
    for (std::size_t b = 0; b < record.places.size() && layout.keep() == Keep::trials; ++b) {
        const JournalBlock& block = record.start.blocks[b];
        const std::string bytes = journal.read(record.places[b], layout.details_offset(0, block.trials));
        followed.in_journal.add(block.index, sums_of(results, block.trials, [&](std::size_t arm, std::size_t column) {
            const auto at = static_cast<std::size_t>(layout.column_offset(arm, column, block.trials));
            std::vector<double> values(static_cast<std::size_t>(block.trials));
            ByteReader from(bytes.data() + at, bytes.size() - at);
            get_values(from, results.columns[column].type, values.data(), values.size());
            return values;
        }));
    }
    followed.in_file.asked(record.start.trials);
    followed.in_journal.asked(record.start.trials);
    followed.counted = record.start.counted;
    followed.totals = journal.read(record.totals, record.end - record.totals);
    asked_ = std::max(asked_, record.start.trials);
    shard_ = record.start.shard;
}

WatchedSums JournalFollower::sums(std::size_t scenario) const {
    if (header_.study.keep == Keep::aggregates) return sums_of_aggregates(study_.scenarios[scenario]);
    const Followed& followed = followed_[scenario];
    WatchedSums sums;
    followed.in_file.add_to(sums);
    if (!followed.already_in_file()) followed.in_journal.add_to(sums);
    return sums;
}

/// Checks that the study is the one that a resumed run would ask for, and that totals and columns agree.
void JournalFollower::check(std::size_t scenario) {
    Followed& followed = followed_[scenario];
    if (!followed.totals) return;
    ScenarioResults& results = study_.scenarios[scenario];
    ByteReader from(followed.totals->data(), followed.totals->size());
    load_totals(results);
    get_totals(from, results);
    drop_totals(results);  // counted and aggregates are kept
    followed.totals.reset();
    if (followed.already_in_file()) return;
    if (followed.trials() != followed.counted) throw BadBytes("totals and blocks do not agree");
    const WatchedSums of_trials = sums(scenario);
    for (std::size_t a = 0; a < of_trials.arms.size(); ++a)
        if (results.arms[a].counted != followed.counted - of_trials.arms[a].failed)
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
        scenario.arms = watched_arms(study_.scenarios[s], sums(s));
        snapshot.scenarios.push_back(std::move(scenario));
    }
}

}  // namespace credence
