#pragma once
// Values of a scenario that are accepted, and that may be a mistake.

#include <credence/detail/scenario.hpp>

#include <string>
#include <vector>

namespace credence {

/// One sentence for each: a standard deviation of an angle above 1 rad may have been meant in degrees. A key is of one
/// where its help begins with `sigma` and ends with `(rad)`, in a user's own world as well. Throws like world_of.
std::vector<std::string> notes_on(const Scenario& scenario);

}  // namespace credence
