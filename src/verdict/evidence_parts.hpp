#pragma once
// What the two files of the evidence share.

#include <credence/evidence.hpp>

namespace credence {

/// Moments of a series over trials at step k + 1, times `scale`.
Moments moments_at(const ArmResults& arm, const SeriesTotals& totals, std::size_t k, double scale);

/// Ratios and bands of totals whose degrees of freedom are filled in.
void fill_bands(const std::vector<double>& totals, BandedRatio& ratio);

/// The block of the state that the nees series f is of.
GroupEvidence block_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f);

/// The block and chart that the series f of role nees_in_chart is of.
ChartEvidence chart_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f);

}  // namespace credence
