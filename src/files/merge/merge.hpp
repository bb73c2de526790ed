#pragma once
// Merging the files of shards, or of interrupted runs, into one study.

#include <credence/detail/store.hpp>

#include <string>
#include <vector>

namespace credence {

/// The union of results files of one study, the same as the result of a single run. The files may come in any order; a
/// block that is in several is taken once, and may be computed again for that by this `release` (empty: not known).
/// Columns stay in the files, and so do totals beyond `most_totals` bytes. Throws InputError where a file cannot be
/// read, is of another study or was asked for other trials, holds a block that differs from another file's, or shares
/// blocks with others that a release computed whose draws or columns may differ.
Study merge_results(const std::vector<std::string>& paths, std::int64_t most_totals = most_totals_in_memory,
                    const std::string& release = {});

/// The blocks that a study lacks, by scenario, such as `scenario a lacks blocks 3, 7 to 9 of 40`; empty for none.
std::string missing_text(const Study& study);

}  // namespace credence
