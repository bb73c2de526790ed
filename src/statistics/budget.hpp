#pragma once
// An error by its sources, each drawn anew with all others held [docs/budget.md; Sobol 1993; Janon, Klein, Lagnoux,
// Nodet, Prieur 2014].
//
//   Runs A and B are two independent worlds; C_s is A with source s of B, D_s is B with source s of A. Of signed errors
//   about their mean x = A - C_s and y = D_s - B: alone V = E[xy]/2, with others T = E[x^2 + y^2]/4.

#include <credence/columns.hpp>
#include <credence/statistics.hpp>

#include <functional>
#include <string>
#include <vector>

namespace credence {

/// What one source contributes to the error of a component or group, in its unit.
struct Contribution {
    std::string source;
    double alone = 0;        ///< sqrt(V); NaN where the estimate of V is below 0
    Interval alone95;        ///< from 0 on
    double share = 0;        ///< V over the variance of the error
    double with_others = 0;  ///< sqrt(T)
    double p_counts = 0;     ///< root of the variance that P counts for the source; NaN where that is not known
    double ratio = 0;        ///< V over that variance; NaN where P counts none
};

/// The budget of a component, or of a group of one unit.
struct BudgetPart {
    std::string name, unit;
    std::vector<Contribution> contributions;  ///< by size
    double mean = 0;          ///< root of the squared mean error
    double interactions = 0;  ///< root of half the sum of T - V: an upper bound where no three sources interact
    double rss = 0, rmse = 0; ///< root of what contributions and mean add up to; root mean square error of A and B
    bool closes = false;      ///< these agree within three standard errors
    double there = 1;         ///< share of its errors that there are in every run; the others are left out
    double p_says = 0, ratio = 0;  ///< root of the variance that P says, and the squared error over it; NaN: not known
};

/// The errors of the runs A, B, C_0, D_0, C_1 ... of one arm, over the trials that count in all of them.
struct BudgetErrors {
    std::vector<std::string> sources;
    std::size_t trials = 0, steps = 0;
    std::vector<Component> components;
    std::vector<ComponentGroup> groups;
    /// [trials, steps] errors of a component in a run. Asked for one after the other, so that few are in memory.
    std::function<std::vector<double>(std::size_t run, std::size_t component)> of;
    /// [n][trials, steps] where a component is in the state in every run; empty where all always are.
    std::vector<std::vector<char>> there{};
    std::vector<double> variance{};   ///< [n] P_jj of A, mean over trials and steps; empty where not known
    std::vector<std::string> counted{};                  ///< the sources that P counts
    std::vector<std::vector<double>> counted_variance{}; ///< [counted][n] of some trials of A
};

/// The groups whose components have one unit, and each component as one.
std::vector<ComponentGroup> groups_of_one_unit(const std::vector<Component>& components,
                                               std::vector<ComponentGroup> groups);

/// The budgets of the groups of one unit, and of the components. At least two trials.
std::vector<BudgetPart> budget_parts(const BudgetErrors& errors);

}  // namespace credence
