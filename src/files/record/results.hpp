#pragma once
// The results of a record, before its trials are added.

#include <credence/results.hpp>

#include "files/record/file.hpp"

#include <string>
#include <vector>

namespace credence {

/// Index of the block `pose`; of the whole state, 0, where there is none.
std::size_t pose_block(const RecordShape& shape);

/// Results with one arm, all of whose totals are 0, columns filled and details NaN; without cells and distances.
ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path);

}  // namespace credence
