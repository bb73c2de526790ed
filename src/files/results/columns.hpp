#pragma once
// The columns of a results file, read in parts, and the trials that they are of.

#include <credence/results.hpp>

#include "files/hdf5/read.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The remedy in messages about a damaged file.
inline const char* const another_copy = "Run the study again, or give an undamaged copy";

/// The columns of an arm, in a file that stays open for them.
std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const hdf5::Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns);

/// Throws where a column has wrong dimensions or the wrong type, or holds an invalid status. Returns the number of
/// trials that did not fail, from the status column.
std::optional<std::int64_t> check_column(const hdf5::Handle& group, const Column& column, std::int64_t trials);

/// The blocks of the trials in an arm's group, of a study that was asked for `asked`. Throws where a block is not
/// complete, except for the study's last.
BlockRanges read_blocks(const hdf5::Handle& group, std::int64_t asked);

}  // namespace credence
