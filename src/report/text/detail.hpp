#pragma once
// The text report's part on one scenario.

#include <credence/report.hpp>

#include <string>

namespace credence {

/// Columns of the arms and their paired differences, and the steps at which each arm's filter is inconsistent.
std::string scenario_detail(const Report& report, const Scenario& scenario);

}  // namespace credence
