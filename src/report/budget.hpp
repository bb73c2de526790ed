#pragma once
// Budgets of errors as text, JSON and CSV.

#include "study/budget.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// Budgets, and of which component or group the text is.
struct BudgetReport {
    std::vector<ArmBudget> arms;
    std::uint64_t root_seed = 1;
    std::string of;  ///< empty: the first of one unit
};

/// `text`; `json`: an object for each scenario and arm; or `csv`: a row for each scenario, arm, part and source.
std::string budget_in(const BudgetReport& report, const std::string& format);

}  // namespace credence
