#pragma once
// Parts of the engine by themselves, and the processor's peak.

#include "trials.hpp"

namespace credence::bench {

/// Registers part/TARGET/draws, part/TARGET/filter_step and part/TARGET/peak.
void add_parts(const Effort& effort);

Table parts_table();

}  // namespace credence::bench
