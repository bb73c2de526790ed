#pragma once
// The columns of a results file, read in parts, and the trials that they are of.

#include <credence/detail/results.hpp>

#include "files/hdf5/read.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The remedy in messages about a damaged file.
inline const char* const another_copy = "Run the study again, or give an undamaged copy";

/// A column that was read once: checksums of its values, `block_size` rows at a time, and the number of trials that did
/// not fail, from the status column.
struct CheckedColumn {
    std::vector<std::uint32_t> sums;
    std::optional<std::int64_t> counted;
};

/// Reads a column of an arm's group. Throws where it has wrong dimensions or the wrong type, holds an invalid status,
/// or does not have its checksum.
CheckedColumn check_column(const hdf5::Handle& group, const Column& column, std::int64_t trials);

/// The columns of an arm, in a file that stays open for them; `sums` of each are those of check_column. Reading throws
/// where the values have others now.
std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const hdf5::Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns,
                                                   const std::vector<std::vector<std::uint32_t>>& sums);

/// The blocks of the trials in an arm's group, of a study that was asked for `asked`. Throws where a block is not
/// complete, except for the study's last.
BlockRanges read_blocks(const hdf5::Handle& group, std::int64_t asked);

}  // namespace credence
