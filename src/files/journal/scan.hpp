#pragma once
// Finding a journal's header and records, for the run that goes on with it and for who only looks.

#include "files/journal/file.hpp"
#include "files/journal/commit.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace credence {

/// Throws InputError: the journal is damaged, and why.
[[noreturn]] void refuse_damaged(const std::string& path, const std::string& why);

struct FoundHeader {
    JournalHeader header;
    std::int64_t size = 0;  ///< where the records begin
};

/// The header; nothing where the journal is new, or was torn before anything could be committed. Throws InputError
/// where it is damaged or no journal of this version.
std::optional<FoundHeader> find_header(const JournalBytes& file);

/// A record whose checksum is right.
struct FoundCommit {
    std::uint32_t scenario = 0;
    CommitStart start;
    std::vector<std::int64_t> places;  ///< where the values of each of start.blocks begin in the file
    std::int64_t totals = 0;           ///< where the totals begin
    std::int64_t end = 0;              ///< of the totals
    std::uint32_t checksum = 0;
};

/// Calls `found` for every record from `position` on, up to one that is torn or has another checksum; returns where
/// that one begins. `layouts` are those of the study's scenarios. Throws BadBytes for a record that cannot be,
/// InputError where the file cannot be read.
std::int64_t scan_commits(const JournalBytes& file, std::int64_t position, const std::vector<BlockLayout>& layouts,
                          const std::function<void(const FoundCommit&)>& found);

}  // namespace credence
