#pragma once
// The parts of an arm's totals and details, each named once: journal, merge and memory go through them here.

#include <credence/detail/results.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace credence {

/// Adds a part of totals to that of others, or takes it back.
inline void add(std::int64_t& to, std::int64_t from, int sign = 1) { to += sign * from; }
template <class T>
void add(T& to, const T& from, int sign = 1) { to.add(from, sign); }
template <class T>
void add(std::vector<T>& to, const std::vector<T>& from, int sign = 1) {
    for (std::size_t i = 0; i < to.size(); ++i) add(to[i], from[i], sign);
}

/// Calls visit(part) for each exact sum, list of exact sums and list of counts of the totals but those of trials, in
/// their order in a journal; with several totals of the same scenario, visit(part of the first, part of the second
/// ...).
template <class Visit, class... All>
void visit_totals(Visit&& visit, All&... totals) {
    const auto visit_each = [&](auto&... series) {
        const std::size_t count = std::min({series.size()...});
        for (std::size_t f = 0; f < count; ++f) {
            visit(series[f].sum...);
            visit(series[f].square_sum...);
            visit(series[f].run_square_sum...);
            visit(series[f].covered...);
        }
    };
    visit_each(totals.series...);
    visit_each(totals.diverged...);
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
