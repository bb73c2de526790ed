#pragma once
// Parts of the engine by themselves, and the processor's peak.

#include "trials.hpp"

namespace credence::bench {

/// Registers part/UNIT/draws, part/UNIT/filter_step and part/UNIT/peak.
void add_parts(const Effort& effort);

Table parts_table();

}  // namespace credence::bench
