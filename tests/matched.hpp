#pragma once
// The world in which the linear filter is right.

#include "of_scenarios.hpp"

#include <limits>

namespace credence::test {

/// The truth that the linear filter assumes, every feature always in range: NEES ~ chi-square(n), NIS ~ chi-square(m),
/// innovations white, all of them exactly; P is the same in every trial [docs/model.md, Truth against filter].
inline DeformableSettings matched_linear() {
    DeformableSettings s;
    s.process = Process::translation;
    s.truth = {Deformation::walk, EdgeNoise::independent};
    s.sensor.range_min = 0;
    s.sensor.range_max = std::numeric_limits<double>::infinity();
    s.arms.controllers = {Controller::fixed};
    return s;
}

}  // namespace credence::test
