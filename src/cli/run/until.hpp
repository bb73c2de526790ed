#pragma once
// `credence run --until`: growing a study while saying how precise it is and how far it still has to go.

#include "cli/run/request.hpp"

namespace credence::cli {

/// Grows the study until it is as precise as was asked or at the ceiling; the last look. A line on the standard error
/// after every look, unless quiet.
InterimAnalysis grow_until_precise(Study& study, const RunRequest& request, RunOptions options);

/// At which look and count of trials the run stopped, and the interval of every asked mean there.
std::string stopping_text(const InterimAnalysis& look);

/// The line for a run whose ceiling came first: the widest mean, and the trials that it would need.
std::string imprecision_text(const InterimAnalysis& look, const StoppingRule& rule);

}  // namespace credence::cli
