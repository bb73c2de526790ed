#pragma once
// The budget of a scenario as a study: its worlds A, B, C_s and D_s are scenarios of it, so that threads, lanes, shards
// and resuming are the study's own [docs/budget.md].

#include "statistics/budget.hpp"

#include <credence/study.hpp>

#include <string>
#include <vector>

namespace credence {

/// A, which is the scenario itself but for its columns; B; C_s and D_s of each source. Throws InputError where its
/// world names no sources, or it is one of these scenarios already.
std::vector<Scenario> budget_scenarios(const Scenario& scenario, KeptErrors kept);

/// Throws InputError where there is no component, nor group of one unit, of that name.
void check_part(const std::vector<Component>& components, const std::vector<ComponentGroup>& groups,
                const std::string& name);

/// The budget of an arm.
struct ArmBudget {
    std::string scenario, arm;
    KeptErrors at = KeptErrors::last;
    std::int64_t trials = 0;          ///< that count: completed in all of the worlds
    std::int64_t left_out = 0;        ///< the others
    std::int64_t counted_trials = 0;  ///< over which what P counts is split; 0: it is not known
    std::vector<std::string> sources{};
    std::vector<BudgetPart> parts{};
};

/// The budgets of all arms. Throws InputError where the study has no worlds of a budget, not all of their trials, or
/// fewer than two of these count.
std::vector<ArmBudget> budgets_of(const Study& study);

}  // namespace credence
