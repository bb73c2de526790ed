#pragma once
// The keys of the world of landmarks [docs/estimators.md, The world of landmarks].

#include "worlds/landmarks/settings.hpp"
#include "worlds/deformable/keys.hpp"

namespace credence {

using LandmarkKey = KeyOf<LandmarkSettings>;

/// All keys but scenario.world, grouped by section, in the order in which they are shown.
const std::vector<LandmarkKey>& landmark_keys();

/// start, odometry, heading, measurement
std::vector<DrawSource> landmark_sources();

}  // namespace credence
