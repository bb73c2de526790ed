#pragma once
// Columns of users' own worlds whose values are whole numbers.

#include <cmath>
#include <cstdint>
#include <limits>

namespace credence {

/// Whether files hold a value of such a column as it is.
inline bool is_stored_integer(double value) {
    return std::abs(value) <= std::numeric_limits<std::int32_t>::max() && value == std::nearbyint(value);
}

}  // namespace credence
