#pragma once
// Whether two records are of the same runs.

#include "record/source.hpp"

namespace credence {

/// Throws RecordError naming the first dataset of `record` that shows that its runs are not those of `first`: other
/// numbers of runs, steps or components, another `truth`, other `time` or `steps`. What only one of them has shows
/// nothing.
void require_same_runs(const RecordSource& first, const RecordSource& record);

}  // namespace credence
