#pragma once
// A scenario's totals as bytes: the part of a commit that sums up all blocks so far.

#include <credence/detail/results.hpp>

#include "base/bytes.hpp"

namespace credence {

/// Writes the parts of the results whose size depends on series and steps but not on trials; so the errors of detailed
/// trials are left out.
void put_totals(ByteWriter& to, const ScenarioResults& results);

/// Reads all of them into results of the same scenario. Throws BadBytes where they are not its totals, are invalid, or
/// not those of `trials` trials.
void get_totals(ByteReader& from, ScenarioResults& results, std::int64_t trials);

}  // namespace credence
