#pragma once
// The keys of the world of landmarks [docs/landmarks.md].

#include <credence/landmark_scenario.hpp>
#include <credence/scenario_keys.hpp>

namespace credence {

using LandmarkKey = KeyOf<LandmarkScenario>;

/// All keys but scenario.world, grouped by section, in the order in which they are shown.
const std::vector<LandmarkKey>& landmark_keys();

}  // namespace credence
