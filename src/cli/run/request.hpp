#pragma once
// The parsed options of `credence run`, and the study with which it begins.

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
    std::vector<StoppingGoal> goals;  ///< of --until: options.trials is then the ceiling; none: run them all
    bool trials_given = true;          ///< otherwise a resumed run continues to the number that was asked for before
    Start start = Start::fresh;
    std::int64_t commit_every = 0;
    Keep keep = Keep::trials;
    bool quiet = false;

    StoppingRule rule() const { return {goals, options.trials}; }
};

/// Reads the options. Throws InputError where they are invalid.
RunRequest read_request(const Parsed& parsed);

/// The run to begin or to resume; sets the request's trials where they were not given. Throws InputError where the
/// output cannot be used or holds another study, or the goals do not fit this one.
StoredRun starting_run(RunRequest& request);

}  // namespace credence::cli
