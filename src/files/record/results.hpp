#pragma once
// The results of a record, before its trials are added.

#include <credence/results.hpp>

#include "files/record/file.hpp"

#include <string>
#include <vector>

namespace credence {

/// Index of the group `pose`, or 0, the whole state, if there is no such group.
std::size_t pose_block(const RecordShape& shape);

/// Results with one arm: all totals 0, columns filled, details NaN; without distribution cells and distances.
ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path);

}  // namespace credence
