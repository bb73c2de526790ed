#pragma once
// Reads a run's journal incrementally, snapshot by snapshot.

#include "files/journal/scan.hpp"

#include <credence/study.hpp>

namespace credence {

/// The content that has been read of one journal.
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

}  // namespace credence
