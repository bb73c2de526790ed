#pragma once
// The format of a journal: a header, then commits, each with blocks of one scenario and the scenario's totals after
// them [docs/theory/durability.md, The journal].

#include <credence/detail/store.hpp>

#include "base/bytes.hpp"
#include "files/system/checksum.hpp"

#include <string>
#include <vector>

namespace credence {

/// How the run treats a results file of the same name.
enum class JournalBase : std::uint8_t {
    none,      ///< there was no file
    grown,     ///< the file holds the study's first blocks, the journal the others
    replaced,  ///< the file will be replaced, because of --overwrite
};

/// The study of a journal.
struct JournalHeader {
    JournalBase base = JournalBase::none;
    FileIdentity base_file;   ///< of that file; without its device, whose number may change
    std::int64_t trials = 0;  ///< number of trials that were asked for
    Shard shard;              ///< the part of them that the run computes
    StudyDefinition study;
};
std::string header_bytes(const JournalHeader& header);

/// Reads the header at the start of a file; `size` becomes its size. Throws BadBytes where it is torn or damaged,
/// InputError where the file is not a journal of this version or its scenarios are invalid.
JournalHeader read_header(const std::string& start, const std::string& path, std::size_t& size);
/// Number of bytes that contain the header's length; and this length, read from them.
inline constexpr std::size_t header_prefix = 24;
std::size_t header_size(const std::string& start, const std::string& path);

/// One block of a commit.
struct JournalBlock {
    std::int64_t index = 0;
    std::int32_t trials = 0;
};

/// The positions of a block's values, from the block's first byte on: columns by arm, if trials are kept, then the
/// details by arm.
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
    /// Numbers in a trial's details: its errors, then its NEES, both as floats; then its moments.
    std::int64_t errors() const { return errors_; }
    std::int64_t nees() const { return nees_; }
    std::int64_t moments() const { return moments_; }

private:
    Keep keep_;
    std::vector<std::int64_t> column_at_;  ///< [column_count + 1] bytes of a trial before each column; {0}: none
    std::int64_t arms_, detailed_blocks_, errors_, nees_, moments_;
};

/// Bytes of a value in a column, and the conversion of a value to bytes and back.
std::int64_t value_size(ColumnType type);
void put_values(ByteWriter& to, ColumnType type, const double* values, std::size_t count);
/// Throws BadBytes for an invalid status.
void get_values(ByteReader& from, ColumnType type, double* values, std::size_t count);

/// Types of the columns that are kept.
std::vector<ColumnType> kept_types(const ScenarioResults& results);

/// The values of a block in the order of BlockLayout, `types` being those of the columns that are kept.
void put_block(ByteWriter& to, const std::vector<ColumnType>& types, const Block& block);
/// Reads the details of a block's `trials` trials under one arm, which must be all of `bytes`, into rows from `row` on.
void get_details(ByteReader& from, const BlockLayout& layout, std::int64_t trials, std::int64_t row, ArmResults& to);

/// The fixed part before a commit's payload, and the part of the payload before the blocks' values.
struct CommitHead {
    std::uint32_t scenario = 0;
    std::int64_t payload = 0;  ///< bytes
};
inline constexpr std::size_t commit_head_size = 16, commit_tail_size = 4;
void put_commit_head(ByteWriter& to, const CommitHead& head);
/// Throws BadBytes where no commit begins there.
CommitHead get_commit_head(ByteReader& from);

struct CommitStart {
    std::int64_t trials = 0;           ///< that the study was asked for at that time
    std::int64_t counted = 0;          ///< number of the scenario's trials in the totals
    std::vector<JournalBlock> blocks;  ///< that have values, in their order: all blocks, if trials are kept
    Shard shard{};                     ///< that the run computes
    std::vector<BlockRange> ranges{};  ///< if no trial is kept: all blocks, those that have values in their order
    std::string release{};             ///< that computed the blocks
};
void put_commit_start(ByteWriter& to, const CommitStart& start, Keep keep = Keep::trials);
/// Throws BadBytes where the blocks or the release are invalid. With ranges, `layout` determines which of their blocks
/// have values.
CommitStart get_commit_start(ByteReader& from, const BlockLayout& layout);
inline constexpr std::size_t commit_release_size = 64, commit_start_size = 36 + commit_release_size,
                             journal_block_size = 12, journal_range_size = 16;
/// Size in bytes of the list of blocks.
std::size_t block_list_size(const CommitStart& start, Keep keep);

/// The start of a commit of these blocks, whose values follow in this order.
CommitStart commit_of(const std::vector<std::int64_t>& blocks, std::int64_t trials, const BlockLayout& layout);

/// A scenario's totals, the part of a commit that sums up all blocks so far: writes the parts of the results whose size
/// depends on series and steps but not on trials; so the errors of detailed trials are left out.
void put_totals(ByteWriter& to, const ScenarioResults& results);

/// Reads all of them into results of the same scenario. Throws BadBytes where they are not its totals, are invalid, or
/// not those of `trials` trials.
void get_totals(ByteReader& from, ScenarioResults& results, std::int64_t trials);

/// Throws BadBytes for an invalid shard.
void put_shard(ByteWriter& to, const Shard& shard);
Shard get_shard(ByteReader& from);

/// The bytes of a commit before values and totals of the given size.
std::string commit_start_bytes(std::uint32_t scenario, const CommitStart& start, Keep keep, std::size_t size_after);

/// The checksum over a journal's header and the checksums of its commits, continued with one more checksum.
inline std::uint32_t seal_with(std::uint32_t seal, std::uint32_t record) {
    return checksum(&record, sizeof record, seal);
}

}  // namespace credence
