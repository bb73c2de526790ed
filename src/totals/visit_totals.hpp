#pragma once
// The parts of an arm's totals and details, each named once: journal, merge and memory go through them here.

#include <credence/detail/results.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// Calls visit(part) for each exact sum, list of exact sums and list of counts of the totals but those of trials, in
/// their order in a journal; with several totals of the same scenario, visit(part of the first, part of the second
/// ...).
template <class Visit, class... All>
void visit_totals(Visit&& visit, All&... totals) {
    const std::size_t count = std::min({totals.series.size()...});
    for (std::size_t f = 0; f < count; ++f) {
        visit(totals.series[f].sum...);
        visit(totals.series[f].square_sum...);
        visit(totals.series[f].run_square_sum...);
        visit(totals.series[f].covered...);
    }
    visit(totals.cells...);
    visit(totals.products.sum...);
    visit(totals.products.square_sum...);
    visit(totals.products.count...);
}

/// Calls visit(values, width) for each kind of detail: `values` [detailed trials, width]. Likewise with several arms.
template <class Visit, class... Arm>
void visit_details(const ScenarioResults& results, Visit&& visit, Arm&... arm) {
    const std::int64_t steps = results.steps();
    visit(arm.nees..., steps);
    visit(arm.errors..., steps * results.state_size());
    visit(arm.moments..., std::int64_t{results.moment_count()});
}

}  // namespace credence
