#pragma once
// Parts of a report as JSON. NaN becomes null.

#include <credence/detail/comparison.hpp>
#include <credence/evidence.hpp>
#include <credence/detail/sweep.hpp>

#include <nlohmann/json.hpp>

namespace credence {

using Json = nlohmann::ordered_json;

inline Json interval_json(const Interval& interval) { return Json::array({interval.low, interval.high}); }

/// All of an arm's evidence, by step where it has steps.
Json evidence_json(const Evidence& evidence);

/// The place of a scenario in its sweep: numbers as numbers.
Json sweep_json(const SweepPoint& sweep);

/// An object with a member for each column of the pairs.
Json comparison_json(const Comparison& comparison);

}  // namespace credence
