#pragma once
// What `credence run` was asked to do, and the study that it begins with.

#include "cli/command.hpp"

#include "study/stopping.hpp"
#include "files/stored_run.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace credence::cli {

struct RunRequest {
    std::vector<Scenario> scenarios;
    std::string output;
    std::uint64_t root_seed = 1;
    RunOptions options;
    std::vector<StoppingGoal> goals;  ///< of --until; none: run all of options.trials, else that is the ceiling
    bool trials_given = true;          ///< else a run that goes on does so to what it was asked for before
    Start start = Start::fresh;
    std::int64_t commit_every = 0;
    Keep keep = Keep::trials;
    bool quiet = false;
    int ranks = 1;                     ///< processes that share the run
    bool threads_given = false;        ///< else every rank takes as many as it may have

    StoppingRule rule() const { return {goals, options.trials}; }
};

/// Throws InputError where the options are no request.
RunRequest read_request(const Parsed& parsed);

/// The run to begin or to go on with; sets the request's trials where they were not given. Throws InputError where the
/// output cannot be used, holds another study, or the goals are not of this one.
StoredRun starting_run(RunRequest& request);

}  // namespace credence::cli
