#pragma once
// Reads a run's journal incrementally, snapshot by snapshot.

#include "report/watch/watch.hpp"

#include "files/journal/scan.hpp"
#include "report/watch/blocks.hpp"

namespace credence {

/// A scenario's part of a snapshot, from its totals of trials; how many there are, and shall be, is not set.
WatchedScenario described(const ScenarioResults& results);

/// The content that has been read of one journal.
class JournalFollower {
public:
    /// `results` is the path of the results file, which the journal may extend.
    JournalFollower(const JournalBytes& journal, FoundHeader found, const std::string& results);

    /// Whether the journal begins with everything that was read before.
    bool goes_on_with(const JournalBytes& journal) const;
    /// Reads what was appended since. Throws BadBytes.
    void read(const JournalBytes& journal);
    void tell(Snapshot& snapshot) const;

private:
    /// The state of a scenario.
    struct Followed {
        WatchedBlocks in_file, in_journal;
        std::int64_t counted = 0;           ///< trials in the last totals
        std::optional<std::string> totals;  ///< that were committed since the last snapshot

        /// The run has ended, and only the journal's removal was missing.
        bool already_in_file() const { return in_file.contains(in_journal); }
        std::int64_t trials() const { return in_file.trials() + (already_in_file() ? 0 : in_journal.trials()); }
    };

    void read_file(const std::string& path);
    void take(const JournalBytes& journal, const FoundCommit& record);
    void check(std::size_t scenario);
    /// The checksum of the last commit that was read.
    std::string seal_of(const JournalBytes& journal) const;

    JournalHeader header_;
    Study study_;  ///< without blocks: the structure of its results
    std::vector<BlockLayout> layouts_;
    std::vector<Followed> followed_;
    std::string start_, seal_;
    std::int64_t position_;
    std::int64_t asked_;
    Shard shard_;
};

}  // namespace credence
