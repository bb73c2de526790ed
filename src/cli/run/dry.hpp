#pragma once
// `credence run --dry-run`: what a run is expected to take.

#include "cli/run/request.hpp"

namespace credence::cli {

/// `4`, or `3 x 4` for as many on each of several ranks.
std::string threads_text(const RunRequest& request);

/// Refuses a run that memory or disk cannot hold, as far as that can be told beforehand. A run that stops by itself may take
/// less than its ceiling, and is not refused. Throws InputError.
void check_fit(const RunRequest& request, const Study& study);

/// Prints it, from a trial or some of every scenario.
int dry_run(const RunRequest& request, const Study& study);

}  // namespace credence::cli
