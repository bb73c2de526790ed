#pragma once
// Watching a run: everything committed so far, with intervals, read from FILE.h5.journal during the run and from
// FILE.h5 afterwards [docs/durability.md, Following a run].

#include <credence/columns.hpp>
#include <credence/statistics.hpp>
#include <credence/study.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The columns whose means a snapshot shows, as they are declared. Pairs are compared by the first one, which is
/// trace_P in every world.
std::vector<std::size_t> watched_columns(const std::vector<Column>& columns);

/// One arm, over its trials so far; failed ones are left out of the means.
struct WatchedArm {
    std::string name;
    std::int64_t failed = 0, diverged = 0;  ///< trials
    std::vector<Moments> columns;           ///< of the watched columns
    std::string other;                      ///< the arm's baseline, such as `fixed.X` beside `greedy.X`; empty: none
    Moments difference;                     ///< of trace_P of this arm - that of `other`, by trial, where there is one
};

struct WatchedScenario {
    std::string name;
    std::vector<Column> columns;                     ///< of the watched columns
    std::int64_t trials = 0, trials_asked = 0;       ///< committed, and the final number
    std::int64_t blocks = 0, blocks_asked = 0;       ///< of 256 trials, likewise
    std::vector<WatchedArm> arms;
};

enum class RunState {
    begun,       ///< its journal cannot be read yet
    running,     ///< there is a journal; seconds_since_commit shows whether the run is alive
    complete,    ///< the results file has every trial that was asked for
    incomplete,  ///< the results file is that of a shard, or of a run that was stopped
};

/// A snapshot of a run.
struct Snapshot {
    std::string path;                        ///< of the results file
    RunState state = RunState::begun;
    std::int64_t trials = 0;                 ///< of each scenario that the study was asked for
    Shard shard;                             ///< of them; of a finished part, if its blocks are those of a shard
    std::vector<WatchedScenario> scenarios;
    double seconds_since_commit = 0;         ///< while there is a journal
    std::optional<double> trials_per_second; ///< over the snapshots of the last minute; none at the first

    bool ended() const { return state == RunState::complete || state == RunState::incomplete; }
    /// Over all scenarios.
    std::int64_t trials_done() const;
    std::int64_t trials_asked() const;
    /// Seconds; nothing where the rate is unknown or 0.
    std::optional<double> time_left() const;
};

class JournalFollower;

/// Watches the run that writes the results file `path`. It neither writes nor locks anything, so the run is not
/// affected. A snapshot reads what was appended to the journal since the last one; memory grows by some bytes for each
/// block of 256 trials.
class RunWatch {
public:
    explicit RunWatch(std::string path);
    RunWatch(RunWatch&&) noexcept;
    ~RunWatch();

    /// Throws InputError where there is neither a journal nor a results file, or where these are damaged.
    Snapshot snapshot();

private:
    std::string path_;
    std::unique_ptr<JournalFollower> follower_;  ///< of the journal, while there is one
    /// When a snapshot was taken, and the number of its trials.
    struct Moment {
        double seconds = 0;
        std::int64_t trials = 0;
    };
    std::vector<Moment> moments_;

    std::optional<Snapshot> journal_snapshot();
    Snapshot results_snapshot() const;
    void time(Snapshot& snapshot);
};

/// The snapshot as text: a table with lines of about 120 characters.
std::string watch_text(const Snapshot& snapshot);
/// An array with an object per scenario and arm; NaN is null.
std::string watch_json(const Snapshot& snapshot);

}  // namespace credence
