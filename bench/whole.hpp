#pragma once
// More than one core, and more than the engine: run_study on threads; the program with its results file.

#include "measure.hpp"
#include "table.hpp"

namespace credence::bench {

/// Registers threads/NAME/T: run_study of one scenario, T = 1 ... all.
void add_threads(const Effort& effort);
/// Wall times; efficiency t1 / (T tT).
Table threads_table(const Effort& effort);

/// Registers program/NAME/...: the program as a child process, its engine alone, its writing alone, the disk alone.
void add_program(const Effort& effort);
Table program_table(const Effort& effort);

}  // namespace credence::bench
