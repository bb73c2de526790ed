#pragma once
// Checks that a results file is consistent where it stores the same information twice.

#include <credence/study.hpp>

#include <string>

namespace credence {

/// Throws InputError where totals over the trials differ from those of the trials' own columns, for the quantities that
/// are stored as both. Merging and resuming, which carry totals over into another file, call this. It reads those
/// columns once.
void check_agreement(const Study& study, const std::string& path);
void check_agreement(const ScenarioResults& results, const std::string& path);

}  // namespace credence
