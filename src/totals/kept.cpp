// Totals and details that are loaded into memory only while they are needed.

#include "numeric/chi_square.hpp"
#include <credence/detail/results.hpp>
#include "totals/visit_totals.hpp"

#include <type_traits>

namespace credence {

namespace {

std::size_t lags_of(const ScenarioResults& results) {
    return static_cast<std::size_t>(lag_count(results.scenario.poses));
}

SeriesTotals no_totals(const Series& series, std::size_t steps) {
    return {std::vector<ExactSum>(steps), std::vector<ExactSum>(series.integer ? 0 : steps), {}, {},
            std::vector<std::int64_t>(series.role == SeriesRole::nees ? steps * coverage_level_count : 0)};
}

/// The same scenario without any block, and without memory for columns.
ScenarioResults without_blocks(const ScenarioResults& results) {
    ScenarioResults empty{results.scenario, results.columns, results.all_series, {}, 0, {}, results.keep};
    name_arms(empty);
    clear_totals(empty);
    return empty;
}

}  // namespace

void clear_totals(ScenarioResults& results) {
    const auto steps = static_cast<std::size_t>(results.steps()), lags = lags_of(results);
    for (ArmResults& arm : results.arms) {
        arm.totals.series.clear();
        arm.totals.diverged.clear();
        for (const Series& series : results.all_series) arm.totals.series.push_back(no_totals(series, steps));
        if (distribution_counted(results.steps())) arm.totals.cells.assign(steps * distribution_cells, 0);
        arm.totals.products = {std::vector<ExactSum>(lags), std::vector<ExactSum>(lags),
                               std::vector<std::int64_t>(lags)};
    }
}

void name_arms(ScenarioResults& results) {
    std::vector<TrialTotals> none = empty_trial_totals(results.columns, results.scenario.arms.size());
    for (std::size_t a = 0; a < none.size(); ++a) {
        results.arms.emplace_back();
        results.arms.back().name = results.scenario.arms[a];
        results.arms.back().totals.trials = std::move(none[a]);
    }
}

bool has_totals(const ScenarioResults& results) {
    return results.arms.empty() || !results.arms.front().totals.series.empty();
}

std::int64_t totals_size(const ScenarioResults& results, std::int64_t detailed) {
    constexpr std::int64_t sum_size = sizeof(ExactSum) + 48;  // with the capacity of a few parts
    const std::int64_t steps = results.steps(), number = sizeof(double);
    std::int64_t size = detailed * (steps * (results.state_size() + 1) + results.moment_count()) * number;
    if (distribution_counted(results.steps())) size += steps * distribution_cells * number;
    for (const Series& series : results.all_series) {
        size += steps * (series.integer ? 1 : 2) * sum_size;
        if (series.role == SeriesRole::nees) size += steps * coverage_level_count * number;
    }
    return static_cast<std::int64_t>(results.arms.size()) * size;
}

void load_totals(ScenarioResults& results) {
    if (has_totals(results)) return;
    ScenarioResults there = without_blocks(results);
    if (results.kept_totals) (*results.kept_totals)(there);
    set_blocks(there, results.blocks, trials_up_to(results));
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        ArmResults &to = results.arms[a], &from = there.arms[a];
        to.totals = std::move(from.totals);
        visit_details(results, [](auto& values, auto& loaded, std::int64_t) { values = std::move(loaded); }, to, from);
    }
}

void drop_totals(ScenarioResults& results) {
    const auto free = [](auto& values) { values = std::remove_reference_t<decltype(values)>(); };  // {} would not
    for (ArmResults& arm : results.arms) {
        free(arm.totals.series);
        free(arm.totals.diverged);
        free(arm.totals.cells);
        free(arm.totals.products);
        visit_details(results, [&](auto& values, std::int64_t) { free(values); }, arm);
    }
}

bool TotalsInMemory::take(const ScenarioResults& results) {
    const std::int64_t size = totals_size(results, results.detailed());
    if (size > left_) return false;
    left_ -= size;
    return true;
}

void TotalsInMemory::limit(ScenarioResults& results) {
    if (!take(results) && results.kept_totals) drop_totals(results);
}

void TotalsInMemory::load(ScenarioResults& results) {
    if (take(results)) load_totals(results);
}

WithTotals::WithTotals(const ScenarioResults& results) : results_(results) {
    if (has_totals(results)) return;
    loaded_ = results;
    load_totals(*loaded_);
}

}  // namespace credence
