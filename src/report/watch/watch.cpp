#include "report/watch/watch.hpp"

#include <credence/error.hpp>
#include "files/journal/scan.hpp"
#include "files/stored_run.hpp"

#include "base/wording.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace credence {

/// Reads a run's journal incrementally, snapshot by snapshot: the content that has been read of it.
class JournalFollower {
public:
    /// `results` is the path of the results file, which the journal may extend.
    JournalFollower(const JournalBytes& journal, const FoundHeader& found, const std::string& results);

    /// Whether the journal begins with everything that was read before.
    bool goes_on_with(const JournalBytes& journal) const;
    /// Reads what was appended since. Throws BadBytes.
    void read(const JournalBytes& journal);

    /// Everything committed so far: blocks, and totals of trials; neither trials nor other totals.
    const Study& study() const { return study_; }
    const Shard& shard() const { return shard_; }

private:
    struct Followed {
        PlacedBlocks in_file;
        JournalScenario in_journal;
        std::int64_t read = 0;  ///< the position of the totals that were read last
    };

    void read_file(const std::string& path, const StudyDefinition& expected);
    void read_totals(const JournalBytes& journal, std::size_t scenario);
    /// The checksum of the last commit that was read.
    std::string seal_of(const JournalBytes& journal) const;

    Study study_;
    std::vector<BlockLayout> layouts_;
    std::vector<Followed> followed_;
    std::string start_, seal_;
    std::int64_t position_;
    Shard shard_;
};

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
        throw InputError("is not the file that its journal extends", difference, "Put that back, or remove the journal")
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

namespace {

/// A part of a scenario.
struct Size {
    std::int64_t blocks = 0, trials = 0;
};

/// What a shard has of these blocks, the first `trials` trials being those up to the last of them. Counted without a
/// list of the shard's blocks, since a file may claim any number of trials.
Size size_in(const Shard& shard, const BlockRanges& blocks, std::int64_t trials) {
    const auto below = [&](std::int64_t block) {
        return block <= shard.index ? 0 : (block - 1 - shard.index) / shard.count + 1;
    };
    Size size;
    for (const BlockRange& range : blocks.ranges()) size.blocks += below(range.last + 1) - below(range.first);
    size.trials = block_size * size.blocks;
    if (!blocks.empty() && blocks.back() % shard.count == shard.index)
        size.trials -= block_size - trials_in_block(trials, blocks.back());
    return size;
}

Size size_of(const Shard& shard, std::int64_t trials) {
    return size_in(shard, BlockRanges::below(block_count(trials)), trials);
}

/// The shard that has exactly these blocks; the whole study where there is no such shard.
Shard shard_of(const BlockRanges& blocks, std::int64_t trials) {
    if (blocks.size() < 2) return {};
    const Shard shard{blocks[0], blocks[1] - blocks[0]};
    const std::int64_t count = blocks.count();
    return shard.index < shard.count && size_in(shard, blocks, trials).blocks == count &&
                   size_of(shard, trials).blocks == count
               ? shard
               : Shard{};
}

WatchedArm watched_arm(const ScenarioResults& results, const ArmResults& arm, const std::vector<std::size_t>& columns) {
    const TrialTotals& totals = arm.totals.trials;
    WatchedArm watched{arm.name,
                       totals.trials() - totals.counted() - totals.diverged(),
                       totals.statuses[static_cast<std::size_t>(Status::diverged)],
                       {},
                       {},
                       {}};
    for (const std::size_t column : columns) watched.columns.push_back(column_moments(arm, column));
    if (const ArmResults* other = baseline_of(results, arm)) {
        watched.other = other->name;
        watched.difference = moments_of(column_differences(results, arm, *other, columns.front()).difference);
    }
    return watched;
}

WatchedScenario watched_scenario(const ScenarioResults& results, std::int64_t trials, const Shard& shard) {
    // What is there already may be of other shards, too.
    const Size there = size_in(shard, results.blocks, trials_up_to(results)), asked = size_of(shard, trials);
    const std::int64_t blocks = results.blocks.count();
    WatchedScenario scenario{results.scenario.name, {}, results.trials, results.trials + asked.trials - there.trials,
                             blocks, blocks + asked.blocks - there.blocks, {}};
    const std::vector<std::size_t> columns = watched_columns(results.columns);
    for (const std::size_t column : columns) scenario.columns.push_back(results.columns[column]);
    for (const ArmResults& arm : results.arms) scenario.arms.push_back(watched_arm(results, arm, columns));
    return scenario;
}

Snapshot snapshot_of(const std::string& path, RunState state, const Study& study, const Shard& shard) {
    Snapshot snapshot{path, state, study.trials, shard, {}, 0, {}};
    for (const ScenarioResults& results : study.scenarios)
        snapshot.scenarios.push_back(watched_scenario(results, study.trials, shard));
    return snapshot;
}

}  // namespace

std::vector<std::size_t> watched_columns(const std::vector<Column>& columns) {
    std::vector<std::size_t> watched;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (is_reported(columns[c]) && columns[c].places.watch) watched.push_back(c);
    return watched;
}

std::int64_t Snapshot::trials_done() const {
    std::int64_t trials = 0;
    for (const WatchedScenario& scenario : scenarios) trials += scenario.trials;
    return trials;
}

std::int64_t Snapshot::trials_asked() const {
    std::int64_t trials = 0;
    for (const WatchedScenario& scenario : scenarios) trials += scenario.trials_asked;
    return trials;
}

std::optional<double> Snapshot::time_left() const {
    if (!trials_per_second || !(*trials_per_second > 0)) return std::nullopt;
    return static_cast<double>(trials_asked() - trials_done()) / *trials_per_second;
}

RunWatch::RunWatch(std::string path) : path_(std::move(path)) {}
RunWatch::RunWatch(RunWatch&&) noexcept = default;
RunWatch::~RunWatch() = default;

/// Nothing where there is no journal.
std::optional<Snapshot> RunWatch::journal_snapshot() {
    const std::string path = journal_path_of(path_);
    for (int attempt = 0;; ++attempt) {
        const std::optional<JournalBytes> journal = JournalBytes::open(path);
        if (!journal) return std::nullopt;
        try {
            if (follower_ && !follower_->goes_on_with(*journal)) follower_.reset();
            Snapshot snapshot{path_, RunState::begun, 0, {}, {}, 0, {}};
            if (!follower_)
                if (const std::optional<FoundHeader> found = find_header(*journal))
                    follower_ = std::make_unique<JournalFollower>(*journal, *found, path_);
            if (follower_) {
                follower_->read(*journal);
                snapshot = snapshot_of(path_, RunState::running, follower_->study(), follower_->shard());
            }
            snapshot.seconds_since_commit = journal->seconds_since_change();
            return snapshot;
        } catch (const BadBytes& bad) {
            follower_.reset();
            if (attempt > 0) refuse_damaged(path, bad.what());
        } catch (const InputError&) {
            follower_.reset();
            if (attempt > 0) throw;
        }
        // The journal may have been cut, started over or finished while it was read, so it is read once more from the
        // start.
    }
}

Snapshot RunWatch::results_snapshot() const {
    std::error_code trouble;
    if (!std::filesystem::exists(path_, trouble) && !trouble)
        throw InputError("nothing to watch: neither " + path_ + " nor " + journal_path_of(path_) + " is there", {},
                         "Check the name, or begin with " + as_command({"run", "SCENARIO.ini", "-o", path_}));
    const Study study = read_results(path_, 0).study;
    Shard shard;
    if (!study.complete && !study.scenarios.empty()) {
        const BlockRanges& blocks = study.scenarios.front().blocks;
        const bool all_same = std::ranges::all_of(
            study.scenarios, [&](const ScenarioResults& results) { return results.blocks == blocks; });
        if (all_same) shard = shard_of(blocks, study.trials);
    }
    return snapshot_of(path_, study.complete ? RunState::complete : RunState::incomplete, study, shard);
}

void RunWatch::time(Snapshot& snapshot) {
    constexpr double longest = 60;
    using namespace std::chrono;
    const Moment now{duration<double>(steady_clock::now().time_since_epoch()).count(), snapshot.trials_done()};
    if (!moments_.empty() && now.trials < moments_.back().trials) moments_.clear();
    moments_.push_back(now);
    while (moments_.size() > 2 && now.seconds - moments_[1].seconds > longest) moments_.erase(moments_.begin());
    const Moment& first = moments_.front();
    if (now.seconds > first.seconds)
        snapshot.trials_per_second = static_cast<double>(now.trials - first.trials) / (now.seconds - first.seconds);
}

Snapshot RunWatch::snapshot() {
    std::optional<Snapshot> snapshot = journal_snapshot();
    if (!snapshot) return results_snapshot();
    time(*snapshot);
    return std::move(*snapshot);
}

}  // namespace credence
