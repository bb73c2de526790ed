#pragma once
// Merging the files of shards, or of interrupted runs, into one study.

#include <credence/detail/store.hpp>

#include <string>
#include <vector>

namespace credence {

/// The union of results files of one study, the same as the result of a single run. The files may come in any order.
/// Columns stay in the files, and so do totals beyond `most_totals` bytes. Throws InputError where a file cannot be
/// read, is of another study, was asked for other trials or computed by a release whose draws or columns may differ,
/// and where two files have the same block.
Study merge_results(const std::vector<std::string>& paths, std::int64_t most_totals = most_totals_in_memory);

/// The blocks that a study lacks, by scenario, such as `scenario a lacks blocks 3, 7 to 9 of 40`; empty for none.
std::string missing_text(const Study& study);

}  // namespace credence
