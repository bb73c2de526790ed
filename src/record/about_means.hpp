#pragma once
// The errors of a record about their mean over the trials, step by step [docs/statistics.md, Attribution].

#include "record/reader.hpp"

#include <credence/record.hpp>

#include <string>
#include <vector>

namespace credence {

/// Whether a record of this shape has what the means are weighted by, and whether they fit into memory.
bool has_step_means(const RecordShape& shape);

/// The results of these trials with errors e - m, m = (sum P^-1)^-1 sum P^-1 e over the trials that have the step,
/// times sqrt(N/(N - 1)), so that NEES of a filter whose P is right stays n [generalised least squares]. Reads the
/// record twice. `counted` [trials]: whether the trial is one of them.
AboutMeans read_about_means(const RecordReader& reader, const std::string& name, const std::vector<char>& counted);

}  // namespace credence
