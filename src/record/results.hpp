#pragma once
// The results of a record, before its trials are added.

#include <credence/detail/results.hpp>

#include "record/reader.hpp"

#include <string>
#include <vector>

namespace credence {

/// Places of a record's columns. What a record does not say, such as `unseen`, is NaN.
namespace RecordColumn {
enum Place { trace_P, unseen, pose_error, nees_ratio, nis_ratio, mean_trace_P, log_score, own };
}
inline const std::string unseen_column = "unseen";

/// Those of RecordColumn, from `own` on those of the record's own (an `unseen` has its place), and the status.
std::vector<Column> record_columns(const RecordShape& shape);

/// Results with one arm: all totals 0, columns filled, details NaN; without distribution cells and distances. By step
/// they have `kept_steps`.
ScenarioResults empty_record_results(const RecordShape& shape, const std::vector<Series>& all_series,
                                     const std::string& path, int kept_steps);

}  // namespace credence
