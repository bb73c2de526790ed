#pragma once
// `credence run --dry-run`: the expected time, memory and file size of a run.

#include "cli/run/request.hpp"

namespace credence::cli {

/// Refuses a run for which memory or disk are too small, as far as that is known in advance. A run with --until may
/// need less than its ceiling, and is not refused. Throws InputError.
void check_fit(const RunRequest& request, const Study& study);

/// Prints the estimate, from one or more trials of every scenario.
int dry_run(const RunRequest& request, const Study& study);

}  // namespace credence::cli
