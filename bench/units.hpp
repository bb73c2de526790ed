#pragma once
// The units that are measured: those that the processor runs, and one more.

#include "worlds/simulate.hpp"

namespace credence::bench {

/// runnable_targets(), and, where AVX2 is, the engine one trial at a time with fused multiply-adds in hardware
/// ("one_lane"): what is left of the gain without lanes is the algebra's and the compiler's.
std::vector<Target> measured_targets();

}  // namespace credence::bench
