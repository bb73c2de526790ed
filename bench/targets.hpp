#pragma once
// The measured targets: those that the processor can run, and one more.

#include "worlds/simulate.hpp"

namespace credence::bench {

/// runnable_targets(), and, where AVX2 is available, the engine one trial at a time with fused multiply-adds in
/// hardware ("one_lane"): its gain over the baselines is due to the algebra and the compiler, not to lanes.
std::vector<Target> measured_targets();

}  // namespace credence::bench
