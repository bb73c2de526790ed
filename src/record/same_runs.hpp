#pragma once
// Whether two records are of the same runs.

#include "record/source.hpp"

namespace credence {

/// Throws RecordError naming what shows that the runs of `record` are not those of `first`: another seed, other numbers
/// of runs, steps or components, other `trial`, `truth`, `time` or `steps`. What only one of them has shows
/// nothing.
void require_same_runs(const RecordSource& first, const RecordSource& record);

}  // namespace credence
