#pragma once
// A scenario's totals as bytes: what a journal's commit says of all blocks up to it.

#include <credence/results.hpp>

#include "base/bytes.hpp"

namespace credence {

/// Everything of the results that grows with series and steps and not with trials; the errors of detailed trials too
/// are left out.
void put_totals(ByteWriter& to, const ScenarioResults& results);

/// Reads them into results of the same scenario. Throws BadBytes where they are not its totals, or cannot be.
void get_totals(ByteReader& from, ScenarioResults& results);

}  // namespace credence
