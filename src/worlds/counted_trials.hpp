#pragma once
// What P counts for each source, of any world: in how many trials, and how near to P it must be.

#include "slam/trial/problem.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <cstdint>
#include <string>

namespace credence {

/// Trials that are run for it: 256, or fewer where their states are large and their steps many.
inline std::int64_t counted_trials(const CommonView& view, std::int64_t trials) {
    const double room = 4e7 / (static_cast<double>(view.poses) * view.state_size * view.state_size);
    return std::min(trials, std::clamp(static_cast<std::int64_t>(room), std::int64_t{16}, std::int64_t{256}));
}

/// Throws Failure where the parts of P differ from it by more than rounding. `rest` is relative to its entries.
inline void check_rest(double rest, std::int64_t trial, const std::string& remedy) {
    constexpr double largest_rest = 1e-6;
    if (!(rest <= largest_rest))
        throw Failure("cannot tell what P counts for each source",
                      "in trial " + std::to_string(trial) + " they differ from P by " + to_text(rest) + " of it",
                      remedy);
}

}  // namespace credence
