#pragma once
// The names of the datasets of an arm.

#include <credence/study.hpp>

#include "numeric/chi_square.hpp"

#include <iterator>

#include <string>
#include <vector>

namespace credence {

/// The group within an arm's that has the series of the trials that the verdict counts, where others diverged.
inline const std::string without_diverged = "without_diverged";

inline const std::vector<double> levels_of_coverage(std::begin(coverage_levels), std::end(coverage_levels));
inline std::string coverage_name(const Series& series) { return series.name + "_covered"; }

/// Names of the datasets of the series.
std::vector<std::string> series_links(const ScenarioResults& results);

/// Names of the datasets in the group of the next arm.
std::vector<std::string> arm_links(const ScenarioResults& results);

/// Throws InputError where two datasets of an arm would have one name: those of columns, groups and components of a
/// user's own world.
void refuse_clashing_links(const Study& study);

}  // namespace credence
