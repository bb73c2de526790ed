#pragma once
// The value of a number that does not exist.

#include <limits>

namespace credence {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace credence
