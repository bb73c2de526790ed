#pragma once
// Budgets of errors as text, JSON, CSV and a page.

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

/// The part of that name; the first without one.
const BudgetPart& part_of(const ArmBudget& arm, const std::string& name);
/// `position [dm]`
std::string name_with_unit(const BudgetPart& part);
/// When its errors are, of how many trials of which arm.
std::string arm_sentence(const ArmBudget& arm);

/// `text`; `json`: an object for each scenario and arm; or `csv`: a row for each scenario, arm, part and source.
std::string budget_in(const BudgetReport& report, const std::string& format);
/// A page: bars of the part that is asked for, and the tables of all parts. `made_by` is the release.
std::string budget_html(const BudgetReport& report, const std::string& made_by);

}  // namespace credence
