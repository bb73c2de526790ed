#pragma once
// The results of a record, before its trials are added.

#include <credence/detail/results.hpp>

#include "record/reader.hpp"

#include <string>
#include <vector>

namespace credence {

/// Places of a record's columns. What a record does not say, such as `unseen`, is NaN.
namespace RecordColumn {
enum Place { trace_P, unseen, pose_error, nees_ratio, nis_ratio, mean_trace_P, log_score, status, status_pose };
}
inline constexpr std::size_t record_column_count = RecordColumn::status_pose + 1;

/// Results with one arm: all totals 0, columns filled, details NaN; without distribution cells and distances. By step
/// they have `kept_steps`.
ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path, int kept_steps);

}  // namespace credence
