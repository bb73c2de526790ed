#pragma once
// Room 13: the text report's part on one scenario.

#include <credence/report.hpp>

#include <string>
#include <vector>

namespace credence {

/// The figure of that name; the first one where there is none.
const FigureReport& figure_named(const std::vector<FigureReport>& figures, const std::string& name);

/// Figures of the arms and their paired differences, and where each arm's filter is off.
std::string scenario_detail(const Report& report, const Scenario& scenario);

}  // namespace credence
