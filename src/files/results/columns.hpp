#pragma once
// The columns of a results file, read a part at a time, and the trials that they are of.

#include <credence/results.hpp>

#include "files/hdf5/read.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// What is asked of a damaged file.
inline const char* const another_copy = "Run the study again, or give an undamaged copy";

/// The columns of an arm in a file that stays open for them.
std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const hdf5::Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns);

/// Throws where a column has another shape or type, or holds a status that is none. Returns how many trials did not
/// fail, of the status column.
std::optional<std::int64_t> check_column(const hdf5::Handle& group, const Column& column, std::int64_t trials);

/// The blocks that the trials in an arm's group make, of a study that was asked for `asked`. Throws where a block is not
/// whole, but for the study's last.
BlockRanges read_blocks(const hdf5::Handle& group, std::int64_t asked);

}  // namespace credence
