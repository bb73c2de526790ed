#pragma once
// Room 14: what `credence run` was asked to do, and the study that it begins with.

#include "command.hpp"

#include <credence/stopping.hpp>

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
    bool resume = false, overwrite = false, quiet = false;

    StoppingRule rule() const { return {goals, options.trials}; }
};

/// Throws InputError where the options are no request.
RunRequest read_request(const Parsed& parsed);

/// The study to go on with: new, or what the results file holds. Throws InputError where the output cannot be used, it
/// holds another study, or the goals are not of this one.
Study starting_study(const RunRequest& request);

}  // namespace credence::cli
