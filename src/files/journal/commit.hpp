#pragma once
// What a journal is made of: a header, then records, each the blocks of one scenario that one commit brought
// and its totals after them [docs/durability.md, The journal].

#include <credence/store.hpp>

#include "base/bytes.hpp"

#include <string>
#include <vector>

namespace credence {

/// What the run does with the results file that has its name.
enum class JournalBase : std::uint8_t {
    none,      ///< there was none
    grown,     ///< it holds the study's first blocks, the journal the others
    replaced,  ///< it goes, as --overwrite said
};

/// The study that a journal belongs to.
struct JournalHeader {
    JournalBase base = JournalBase::none;
    FileIdentity base_file;   ///< of that file; without its device, of which the number may change
    std::int64_t trials = 0;  ///< that were asked for
    Shard shard;              ///< of them
    StudyDefinition study;
};
std::string header_bytes(const JournalHeader& header);

/// Reads the header that a file begins with; `size` becomes its own. Throws BadBytes where it is torn or damaged,
/// InputError where the file is no journal of this version or its scenarios cannot be.
JournalHeader read_header(const std::string& start, const std::string& path, std::size_t& size);
/// As many bytes as tell how long the header is, and then how long.
inline constexpr std::size_t header_prefix = 24;
std::size_t header_size(const std::string& start, const std::string& path);

/// One block of a record.
struct JournalBlock {
    std::int64_t index = 0;
    std::int32_t trials = 0;
};

/// Where the values of a block lie, from the block's first byte on: columns by arm, where they are kept, then the details
/// by arm.
class BlockLayout {
public:
    explicit BlockLayout(const ScenarioResults& results);

    std::int64_t size(const JournalBlock& block) const;
    std::int64_t details_size(std::int64_t trials) const;  ///< of one arm
    std::int64_t column_offset(std::size_t arm, std::size_t column, std::int64_t trials) const;
    std::int64_t details_offset(std::size_t arm, std::int64_t trials) const;
    bool detailed(std::int64_t index) const { return index < detailed_blocks_; }
    std::int64_t detailed_blocks() const { return detailed_blocks_; }
    Keep keep() const { return keep_; }
    /// Floats of details that a trial has: its errors, then its NEES.
    std::int64_t errors() const { return errors_; }
    std::int64_t nees() const { return nees_; }

private:
    Keep keep_;
    std::vector<std::int64_t> column_at_;  ///< [column_count + 1] bytes of a trial before each column; {0}: none is kept
    std::int64_t arms_, detailed_blocks_, errors_, nees_;
};

/// Bytes of a value in a column, and the values of one put as bytes and taken from them.
std::int64_t value_size(ColumnType type);
void put_values(ByteWriter& to, ColumnType type, const double* values, std::size_t count);
/// Throws BadBytes for a status that is none.
void get_values(ByteReader& from, ColumnType type, double* values, std::size_t count);

/// Types of the columns that are kept.
std::vector<ColumnType> kept_types(const ScenarioResults& results);

/// The values of a block as BlockLayout has them, `types` being those of the columns that are kept.
void put_block(ByteWriter& to, const std::vector<ColumnType>& types, const Block& block);
/// The details of a block's `trials` trials under one arm, which are all that is read, into rows from `row` on.
void get_details(ByteReader& from, const BlockLayout& layout, std::int64_t trials, std::int64_t row, ArmResults& to);

/// What stands before a record's payload, and what stands in it before the blocks' values.
struct CommitHead {
    std::uint32_t scenario = 0;
    std::int64_t payload = 0;  ///< bytes
};
inline constexpr std::size_t commit_head_size = 16, commit_tail_size = 4;
void put_commit_head(ByteWriter& to, const CommitHead& head);
/// Throws BadBytes where no record begins there.
CommitHead get_commit_head(ByteReader& from);

struct CommitStart {
    std::int64_t trials = 0;           ///< that the study was asked for then
    std::int64_t counted = 0;          ///< trials of the scenario that the totals hold
    std::vector<JournalBlock> blocks;  ///< that have values, in their order: all of them, where the trials are kept
    Shard shard{};                     ///< that the run works on
    std::vector<BlockRange> ranges{};  ///< where no trial is kept: all blocks, those that have values in their order
    std::string release{};             ///< that computed the blocks
};
void put_commit_start(ByteWriter& to, const CommitStart& start, Keep keep = Keep::trials);
/// Throws BadBytes where the blocks or the release cannot be. With ranges, `layout` says which of their blocks have values.
CommitStart get_commit_start(ByteReader& from, const BlockLayout& layout);
inline constexpr std::size_t commit_release_size = 64, commit_start_size = 36 + commit_release_size, journal_block_size = 12, journal_range_size = 16;
/// Of the part that lists the blocks.
std::size_t block_list_size(const CommitStart& start, Keep keep);

/// The start of a record of these blocks, whose values stand in this order.
CommitStart commit_of(const std::vector<std::int64_t>& blocks, std::int64_t trials, const BlockLayout& layout);

/// Throws BadBytes for a shard that is none.
void put_shard(ByteWriter& to, const Shard& shard);
Shard get_shard(ByteReader& from);

/// A record but for its checksum; and what of it stands before values and totals of so many bytes.
std::string commit_bytes(std::uint32_t scenario, const CommitStart& start, Keep keep, const std::string& values,
                         const std::string& totals);
std::string commit_start_bytes(std::uint32_t scenario, const CommitStart& start, Keep keep, std::size_t size_after);

/// CRC-32 of zlib, going on from `crc`.
std::uint32_t checksum(const void* bytes, std::size_t size, std::uint32_t crc = 0);

/// The checksum of a journal's header and of the checksums of its records, with that of one more.
inline std::uint32_t seal_with(std::uint32_t seal, std::uint32_t record) { return checksum(&record, sizeof record, seal); }

}  // namespace credence
