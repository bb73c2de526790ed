#pragma once
// Finding a journal's header and commits, for a run that continues the journal and for programs that only read it.

#include "files/journal/file.hpp"
#include "files/journal/commit.hpp"

#include <functional>
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

}  // namespace credence
