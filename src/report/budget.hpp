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

std::string budget_text(const BudgetReport& report);
/// An object for each scenario and arm.
std::string budget_json(const BudgetReport& report);
/// A row for each scenario, arm, part and source.
std::string budget_csv(const BudgetReport& report);
/// `text`, `json` or `csv`
std::string budget_in(const BudgetReport& report, const std::string& format);

}  // namespace credence
