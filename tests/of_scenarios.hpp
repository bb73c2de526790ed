#pragma once
// Studies of the deformable world, made of its own scenarios.

#include "numeric/chi_square.hpp"
#include "study/block_results.hpp"
#include "worlds/deformable/deformable.hpp"
#include <credence/detail/worlds.hpp>
#include <credence/study.hpp>

#include <algorithm>
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

/// Sets all blocks of `trials` trials, the totals in memory.
inline void extend(ScenarioResults& results, std::int64_t trials) {
    load_totals(results);
    set_blocks(results, BlockRanges::below(block_count(trials)), trials);
}

/// Sets the totals of trials to those of columns that were changed, and leaves out of the counts of the others what is
/// more than that.
inline void recount(ScenarioResults& results) {
    std::vector<TrialTotals> totals = trial_totals(
        results.columns, results.arms.size(), static_cast<std::size_t>(results.trials),
        [&](std::size_t arm, std::size_t column) { return results.arms[arm].columns.in_memory()[column].data(); });
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        Totals& of_arm = results.arms[a].totals;
        of_arm.trials = std::move(totals[a]);
        of_arm.diverged.clear();
        if (of_arm.trials.diverged() > 0) of_arm.of_diverged();
        const std::int64_t counted = of_arm.trials.counted();
        for (SeriesTotals& series : of_arm.series)
            for (std::int64_t& covered : series.covered) covered = std::min(covered, counted);
        for (std::size_t first = 0; first < of_arm.cells.size(); first += distribution_cells) {
            std::int64_t left = counted;
            for (std::size_t i = first; i < first + distribution_cells; ++i)
                left -= of_arm.cells[i] = std::min(of_arm.cells[i], left);
        }
    }
}

inline ScenarioResults empty_results(const DeformableSettings& scenario, Keep keep = Keep::trials) {
    return empty_results(scenario_of(scenario), keep);
}

}  // namespace credence
