#pragma once
// Values of scenarios that are accepted, and that may be a mistake.

#include <credence/detail/scenario.hpp>

#include <string>
#include <vector>

namespace credence {

/// One sentence for each key that has one: a standard deviation of an angle above 1 rad may have been meant in degrees.
/// Throws like world_of.
std::vector<std::string> notes_on(const std::vector<Scenario>& scenarios);

}  // namespace credence
