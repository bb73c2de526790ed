#pragma once
// Declarations shared by the files of the evidence.

#include <credence/evidence.hpp>

namespace credence {

/// The totals of the series of that name; nullptr where there is none.
const SeriesTotals* totals_named(const ScenarioResults& results, const ArmResults& arm, const std::string& name);

/// Moments of a series over trials at step k + 1, times `scale`.
Moments moments_at(const ArmResults& arm, const SeriesTotals& totals, std::size_t k, double scale);

/// Moments over trials of each trial's mean over its steps, times `scale`.
Moments run_moments(const ArmResults& arm, const SeriesTotals& totals, int steps, double scale);

/// Ratios and bands of totals whose degrees of freedom are already set.
void fill_bands(const std::vector<double>& totals, BandedRatio& ratio);

/// The component group of the nees series f.
GroupEvidence group_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f);

/// The group and chart of the series f of role nees_in_chart.
ChartEvidence chart_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f);

/// The NIS of the series f.
NisEvidence nis_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f);

/// Correlations by lag; `scale` is NIS/m: they are given over it too, because a wrong size of S is not correlation.
std::vector<Whiteness> whiteness_evidence(const ScenarioResults& results, const ArmResults& arm, double scale);

/// NEES/n of each quintile of the trials by their mean log det P, the smallest first: moments over its trials. Empty if
/// P hardly varies, for fewer than 100 trials, and where trials are not kept.
std::vector<Moments> quintiles_by_size(const ScenarioResults& results, const ArmResults& arm);

/// Sets what rounding may have done to each group's NEES.
void add_rounding(const ArmResults& arm, Evidence& evidence);

}  // namespace credence
