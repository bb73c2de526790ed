#pragma once
// What has been read of a run's journal, look by look.

#include "report/watch/watch.hpp"

#include "files/journal/scan.hpp"
#include "report/watch/sums.hpp"

namespace credence {

/// A scenario's part of a look, without its figures.
WatchedScenario described(const ScenarioResults& results);

/// Its arms, with the figures of these sums.
std::vector<WatchedArm> watched_arms(const ScenarioResults& results, const WatchedSums& sums);

/// What has been read of one journal.
class JournalFollower {
public:
    /// `results` is the path of the results file, which the journal may grow.
    JournalFollower(const JournalBytes& journal, FoundHeader found, const std::string& results);

    /// Whether the journal begins with all that was read.
    bool goes_on_with(const JournalBytes& journal) const;
    /// Reads what was appended. Throws BadBytes.
    void read(const JournalBytes& journal);
    void tell(Snapshot& look) const;

private:
    /// What is there of a scenario.
    struct Followed {
        WatchedBlocks in_file, in_journal;
        std::int64_t counted = 0;           ///< trials in the last totals
        std::optional<std::string> totals;  ///< that came since the last look

        /// The run had ended, and only the journal had still to go.
        bool already_in_file() const { return in_file.contains(in_journal); }
        std::int64_t trials() const { return in_file.trials() + (already_in_file() ? 0 : in_journal.trials()); }
    };

    void read_file(const std::string& path);
    void take(const JournalBytes& journal, const FoundCommit& record);
    void check(std::size_t scenario);
    WatchedSums sums(std::size_t scenario) const;
    /// The checksum of what was read last.
    std::string seal_of(const JournalBytes& journal) const;

    JournalHeader header_;
    Study study_;  ///< empty: what its results look like
    std::vector<BlockLayout> layouts_;
    std::vector<Followed> followed_;
    std::string start_, seal_;
    std::int64_t position_;
    std::int64_t asked_;
    Shard shard_;
};

}  // namespace credence
