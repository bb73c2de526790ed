#pragma once
// Finding a journal's header and commits, for a run that continues the journal and for programs that only read it; and
// which blocks a journal and the results file that it extends have, and where.

#include "files/journal/file.hpp"
#include "files/journal/commit.hpp"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace credence {

/// Throws InputError: the journal is damaged, and the reason.
[[noreturn]] void refuse_damaged(const std::string& path, const std::string& why);

struct FoundHeader {
    JournalHeader header;
    std::int64_t size = 0;  ///< where the commits begin
};

/// The header; nothing where the journal is new, or was torn before anything could be committed. Throws InputError
/// where it is damaged or not a journal of this version.
std::optional<FoundHeader> find_header(const JournalBytes& file);

/// A commit whose checksum is right.
struct FoundCommit {
    std::uint32_t scenario = 0;
    CommitStart start;
    std::vector<std::int64_t> places;  ///< positions in the file of the values of each of start.blocks
    std::int64_t totals = 0;           ///< position of the totals
    std::int64_t end = 0;              ///< end of the totals
    std::uint32_t checksum = 0;
};

/// Calls `found` for every commit from `position` on, up to one that is torn or has a wrong checksum; returns the
/// position where that one begins. `layouts` are those of the study's scenarios. Throws BadBytes for an invalid commit,
/// InputError where the file cannot be read.
std::int64_t scan_commits(const JournalBytes& file, std::int64_t position, const std::vector<BlockLayout>& layouts,
                          const std::function<void(const FoundCommit&)>& found);

/// The place of a block's values: in the journal, or in the results file that the journal extends.
struct BlockPlace {
    std::int64_t trials = 0;
    std::int64_t position = 0;  ///< in the journal: of the block's first byte; in the results file: of its first row
    bool in_file = false;
};

/// The blocks of a journal and their places. If no trial is kept, only blocks with details and partial blocks have an
/// entry of their own, so that memory does not grow with the number of the other blocks.
struct PlacedBlocks {
    BlockRanges blocks;
    std::map<std::int64_t, BlockPlace> places;

    void put(std::int64_t block, const BlockPlace& place);
    /// Adds blocks without kept trials, of a study of `trials` trials. Those of them with details must have a place
    /// already.
    void put(const BlockRange& range, std::int64_t trials, const BlockLayout& layout);
    /// Adds the blocks of `others`; where both have a block, the others' place is taken.
    void put(const PlacedBlocks& others);
    void remove(std::int64_t block);
    std::int64_t trials_of(std::int64_t block) const;
    std::int64_t trials() const;
    /// Number of trials of the smallest study that has all these blocks.
    std::int64_t trials_up_to() const {
        return blocks.empty() ? 0 : blocks.back() * block_size + trials_of(blocks.back());
    }
    /// Whether `other` has the same blocks with as many trials.
    bool has(const PlacedBlocks& others) const;
};

/// The position of a scenario's last totals in the journal.
struct JournalTotals {
    std::int64_t position = 0, size = 0;

    /// Whether any commit is of that scenario.
    bool found() const { return position > 0; }
};

/// The journal's content for one scenario.
struct JournalScenario {
    PlacedBlocks placed;
    std::int64_t asked = 0;    ///< trials that the study was asked for at the last totals
    std::int64_t counted = 0;  ///< trials in the last totals
    JournalTotals totals;

    void take(const FoundCommit& commit, const BlockLayout& layout);
};

/// The blocks of results, whose rows are those of a results file.
PlacedBlocks places_in_file(const ScenarioResults& results, const BlockLayout& layout);

/// Adds the journal's blocks to those of the results file. A partial block that is larger in the study of the last
/// totals had been removed from the totals before, and is left out. Returns false, and adds nothing, where the journal
/// has no commit, or where the file has all of its blocks: the run had ended, and only the journal's removal was
/// missing. Throws BadBytes where blocks and totals do not agree.
bool add_places(PlacedBlocks& placed, const JournalScenario& found);

}  // namespace credence
