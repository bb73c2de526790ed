#pragma once
// `credence run --until`: grows a study and reports its precision and the trials that are still needed.

#include "cli/run/request.hpp"

namespace credence::cli {

/// Grows the study until it has the requested precision or reaches the ceiling; returns the last interim analysis.
/// Prints a line on the standard error after every analysis, unless quiet.
InterimAnalysis grow_until_precise(Study& study, const RunRequest& request, RunOptions options);

/// The analysis and the count of trials at which the run stopped, and the interval of every requested mean there.
std::string stopping_text(const InterimAnalysis& analysis);

/// The line for a run that reached its ceiling first: the widest mean, and the trials that it would need.
std::string imprecision_text(const InterimAnalysis& analysis, const StoppingRule& rule);

}  // namespace credence::cli
