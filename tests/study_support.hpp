#pragma once
// Small studies, and what it means that two are the same.

#include "of_scenarios.hpp"

namespace credence {

/// Two scenarios with both arms each, of either model; resolved.
std::vector<DeformableSettings> small_scenarios();

/// The study of small_scenarios, run.
Study small_study(std::uint64_t root_seed, std::int64_t trials, int threads);

/// The same bits in every column or what is kept of it, and every total (NaN equals NaN).
bool same_results(const Study& a, const Study& b);

}  // namespace credence
