#pragma once
// Whether a results file agrees with itself, where it says the same thing twice.

#include <credence/study.hpp>

#include <string>

namespace credence {

/// Throws InputError where totals over the trials are not those of the trials' own columns, of the quantities that are
/// kept as both. Merging and resuming, which carry totals on into another file, call this. It reads those columns once.
void check_agreement(const Study& study, const std::string& path);
void check_agreement(const ScenarioResults& results, const std::string& path);

}  // namespace credence
