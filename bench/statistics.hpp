#pragma once
// The cost of the statistics beyond NEES, NIS and trace(P).

#include "measure.hpp"
#include "rows.hpp"
#include "table.hpp"

namespace credence::bench {

/// Registers statistics/NAME/...; nothing where the processor has no AVX-512.
void add_statistics(const std::deque<Row>& rows, const Effort& effort);
Table statistics_table(const std::deque<Row>& rows);

}  // namespace credence::bench
