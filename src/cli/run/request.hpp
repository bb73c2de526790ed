#pragma once
// `credence run`: its parsed options, the study with which it begins, the estimate of --dry-run, and --until.

#include "cli/command.hpp"

#include "study/stopping.hpp"
#include "files/stored_run.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace credence::cli {

struct RunRequest {
    std::vector<Scenario> scenarios;
    std::string output;
    std::uint64_t root_seed = 1;
    RunOptions options;
    std::vector<StoppingGoal> goals;  ///< of --until: options.trials is then the ceiling; none: run them all
    bool trials_given = true;          ///< otherwise a resumed run continues to the number that was asked for before
    Start start = Start::fresh;
    std::int64_t commit_every = 0;
    Keep keep = Keep::trials;
    bool quiet = false;

    StoppingRule rule() const { return {goals, options.trials}; }
};

/// What --budget, or another option of the same choices, asks for.
std::optional<KeptErrors> kept_errors(const Parsed& parsed, const std::string& option);

/// The scenarios of the files, each at every point of the sweep, and with `kept` each world of its budget. Throws
/// InputError.
std::vector<Scenario> scenarios_of(const Parsed& parsed, std::optional<KeptErrors> kept);

/// Reads the options. Throws InputError where they are invalid.
RunRequest read_request(const Parsed& parsed);

/// The run to begin or to resume; sets the request's trials where they were not given. Throws InputError where the
/// output cannot be used or holds another study, or the goals do not fit this one.
StoredRun starting_run(RunRequest& request);

/// Refuses a run for which memory or disk are too small, as far as that is known in advance. A run with --until may
/// need less than its ceiling, and is not refused. Throws InputError.
void check_fit(const RunRequest& request, const Study& study);
/// Prints the expected time, memory and file size, from one or more trials of every scenario.
int dry_run(const RunRequest& request, const Study& study);

/// Grows the study until it has the requested precision or reaches the ceiling; returns the last interim analysis.
/// Prints a line on the standard error after every analysis, unless quiet.
InterimAnalysis grow_until_precise(Study& study, const RunRequest& request, RunOptions options);
/// The analysis and the count of trials at which the run stopped, and the interval of every requested mean there.
std::string stopping_text(const InterimAnalysis& analysis);
/// The line for a run that reached its ceiling first: the widest mean, and the trials that it would need.
std::string imprecision_text(const InterimAnalysis& analysis, const StoppingRule& rule);

}  // namespace credence::cli
