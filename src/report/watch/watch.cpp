#include "report/watch/watch.hpp"

#include <credence/error.hpp>
#include "files/stored_run.hpp"

#include "base/program_name.hpp"
#include "report/watch/follower.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace credence {

namespace {

/// The shard that has exactly these blocks; the whole study where there is no such shard.
Shard shard_of(const ScenarioResults& results, std::int64_t trials) {
    const BlockRanges& blocks = results.blocks;
    if (blocks.size() < 2) return {};
    const Shard shard{blocks[0], blocks[1] - blocks[0]};
    if (shard.count == 1 || shard.index >= shard.count || blocks.count() != blocks_of_shard(shard, trials)) return {};
    std::int64_t next = shard.index;
    for (const std::int64_t block : blocks) {
        if (block != next) return {};
        next += shard.count;
    }
    return shard;
}

}  // namespace

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
            Snapshot snapshot{path_, RunState::begun, 0, {}, {}, journal->seconds_since_change(), {}};
            if (!follower_) {
                const std::optional<FoundHeader> found = find_header(*journal);
                if (!found) return snapshot;
                follower_ = std::make_unique<JournalFollower>(*journal, *found, path_);
            }
            follower_->read(*journal);
            follower_->tell(snapshot);
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
        throw InputError("nothing to watch: neither " + path_ + " nor " + journal_path_of(path_) +
                         " is there. Check the name, or begin with `" + program_name() + " run SCENARIO.ini -o " +
                         path_ + "`.");
    const Study study = read_results(path_, 0).study;
    Snapshot snapshot{path_, study.complete ? RunState::complete : RunState::incomplete, study.trials, {}, {}, 0, {}};
    if (!study.complete && !study.scenarios.empty()) snapshot.shard = shard_of(study.scenarios.front(), study.trials);
    for (const ScenarioResults& results : study.scenarios) {
        if (results.blocks != study.scenarios.front().blocks) snapshot.shard = {};
        WatchedScenario scenario = described(results);
        scenario.trials = results.trials;
        scenario.blocks = results.blocks.count();
        snapshot.scenarios.push_back(std::move(scenario));
    }
    for (WatchedScenario& scenario : snapshot.scenarios) {
        scenario.trials_asked = trials_of_shard(snapshot.shard, study.trials);
        scenario.blocks_asked = blocks_of_shard(snapshot.shard, study.trials);
    }
    return snapshot;
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
