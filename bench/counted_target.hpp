#pragma once
// The engine on counting numbers: a target like any other, which gives the same columns and counts its operations.

#include "worlds/simulate.hpp"

namespace credence::bench {

Target counted_target();

/// Floating-point operations since the program began. Not for several threads.
std::uint64_t counted_operations();

}  // namespace credence::bench
