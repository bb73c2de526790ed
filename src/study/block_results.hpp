#pragma once
// What the engine computes, added to the results of a study: blocks, to the totals and to what is kept of the trials.

#include <credence/detail/block.hpp>
#include <credence/detail/results.hpp>
#include <credence/study.hpp>

#include <vector>

namespace credence {

/// An empty result of a resolved scenario. Throws InputError if there is no such world.
ScenarioResults empty_results(const Scenario& scenario, Keep keep = Keep::trials);

/// The same, its totals not in memory.
ScenarioResults results_without_totals(const Scenario& scenario, Keep keep = Keep::trials);

/// Throws InputError, which begins with `cannot`, where a study that was read back lacks a column of its world: the
/// trials of this program do not go with those that it has.
void require_all_columns(const Study& study, const std::string& cannot);

/// The totals of a block's columns, by arm. Can be called from several threads at once.
std::vector<TrialTotals> trial_totals_of(const ScenarioResults& results, const Block& block);

/// Adds a block's totals.
void add_totals(ScenarioResults& results, const Block& block, const std::vector<TrialTotals>& of_trials);
void add_totals(ScenarioResults& results, const Block& block);

/// Removes a block's totals, exactly: a partial last block is computed again when a study grows.
void remove_totals(ScenarioResults& results, const Block& block);

/// Stores a block's details and columns (if they are kept, and not in a file) at their rows. Different blocks may be
/// stored from several threads at once.
void store_columns(ScenarioResults& results, const Block& block);

}  // namespace credence
