#pragma once
// Studies of the deformable world, made of its own scenarios.

#include "study/block_results.hpp"
#include "worlds/deformable/deformable.hpp"
#include <credence/detail/worlds.hpp>
#include <credence/study.hpp>

#include <vector>

namespace credence {

inline std::vector<Scenario> declarations_of(const std::vector<DeformableSettings>& scenarios) {
    std::vector<Scenario> declared;
    for (const DeformableSettings& scenario : scenarios) declared.push_back(scenario_of(scenario));
    return declared;
}

inline Study new_study(const std::vector<DeformableSettings>& scenarios, std::uint64_t root_seed,
                       Keep keep = Keep::trials) {
    return new_study(declarations_of(scenarios), root_seed, keep);
}

/// Sets the totals of trials to those of columns that were changed.
inline void recount(ScenarioResults& results) {
    std::vector<TrialTotals> totals = trial_totals(
        results.columns, results.arms.size(), static_cast<std::size_t>(results.trials),
        [&](std::size_t arm, std::size_t column) { return results.arms[arm].columns[column].data(); });
    for (std::size_t a = 0; a < results.arms.size(); ++a) results.arms[a].totals.trials = std::move(totals[a]);
}

inline ScenarioResults empty_results(const DeformableSettings& scenario, Keep keep = Keep::trials) {
    return empty_results(scenario_of(scenario), keep);
}

}  // namespace credence
