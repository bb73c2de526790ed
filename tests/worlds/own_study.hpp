#pragma once
// Studies of users' worlds.

#include "study_support.hpp"

#include <credence/study.hpp>

namespace credence::test {

inline Study run(const Scenario& scenario, std::int64_t trials, int threads = 1, std::uint64_t seed = 1) {
    Study study = new_study(std::vector<Scenario>{scenario}, seed);
    RunOptions options;
    options.trials = trials;
    options.threads = threads;
    run_study(study, options);
    return study;
}

}  // namespace credence::test
