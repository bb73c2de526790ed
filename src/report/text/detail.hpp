#pragma once
// The text report's part on one scenario.

#include <credence/report.hpp>

#include <string>

namespace credence {

/// Figures of the arms and their paired differences, and where each arm's filter is off.
std::string scenario_detail(const Report& report, const Scenario& scenario);

}  // namespace credence
