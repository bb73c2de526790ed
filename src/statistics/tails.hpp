#pragma once
// What the tail of NEES over the trials is like, in numbers that a reason can name; nothing is decided by them.

#include <optional>
#include <vector>

namespace credence {

struct Tail {
    double worst_share = 0;  ///< share of the sum that the 1 % largest values carry
    /// Degrees of freedom of Student's t whose squares have such a tail, by Hill's index of the 5 % largest values, at
    /// least ten [Hill 1975]; nothing below 200 values, and where there are 10 or more: that is close to normal.
    std::optional<double> degrees;
};

/// Of positive values without NaN; at least one.
Tail tail_of(std::vector<double> values);

}  // namespace credence
