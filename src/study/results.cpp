#include <credence/detail/results.hpp>

#include "numeric/chi_square.hpp"
#include "study/visit_totals.hpp"

#include <algorithm>
#include <functional>

namespace credence {

namespace {

void add_figure(SeriesTotals& totals, const Series& series, const ArmBlock& from, std::size_t f, std::size_t steps,
                double sign) {
    totals.run_square_sum.add(sign * from.run_square_sums[f]);
    for (std::size_t k = 0; k < steps; ++k) {
        totals.sum[k].add(sign * from.sums[f * steps + k]);
        if (!series.integer) totals.square_sum[k].add(sign * from.square_sums[f * steps + k]);
    }
}

void add_coverage(SeriesTotals& totals, const std::int32_t* covered, std::int64_t sign) {
    for (std::size_t i = 0; i < totals.covered.size(); ++i) totals.covered[i] += sign * covered[i];
}

void add_cells(ArmResults& to, const ArmBlock& from, std::size_t trials, std::int64_t sign) {
    std::int64_t* counts = to.cells.data();  // of one step, [distribution_cells]
    for (const std::uint16_t *cell = from.cells.data(), *end = cell + from.cells.size(); cell != end;
         counts += distribution_cells)
        for (std::size_t trial = 0; trial < trials; ++trial, ++cell)
            if (*cell != no_cell) counts[*cell] += sign;
}

void add_products(ProductTotals& to, const ArmBlock& from, double sign) {
    for (std::size_t lag = 0; lag < from.product_sums.size(); ++lag) {
        to.sum[lag].add(sign * from.product_sums[lag]);
        to.square_sum[lag].add(sign * from.product_square_sums[lag]);
        to.count[lag] += static_cast<std::int64_t>(sign * from.product_counts[lag]);
    }
}

void add_scaled_totals(ScenarioResults& results, const Block& block, int sign) {
    load_totals(results);
    const std::size_t steps = static_cast<std::size_t>(results.steps());
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmBlock& from = block.arms[a];
        ArmResults& to = results.arms[a];
        to.counted += sign * from.counted;
        const std::int32_t* covered = from.covered.data();
        for (std::size_t f = 0; f < results.all_series.size(); ++f) {
            add_figure(to.totals[f], results.all_series[f], from, f, steps, sign);
            add_coverage(to.totals[f], covered, sign);
            covered += to.totals[f].covered.size();
        }
        add_cells(to, from, static_cast<std::size_t>(block.trials), sign);
        add_products(to.products, from, sign);
    }
}

}  // namespace

std::string keep_name(Keep keep) { return keep == Keep::trials ? "trials" : "aggregates"; }

bool is_reported(const Column& column) { return column.type != ColumnType::status && column.name != "status_pose"; }

std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name) {
    std::vector<const ArmResults*> meant;
    for (const ArmResults& arm : results.arms) {
        if (arm.name == name) return {&arm};
        if (controller_of(arm.name) == name) meant.push_back(&arm);
    }
    return meant;
}

const ArmResults* baseline_of(const ScenarioResults& results, const ArmResults& arm) {
    const std::vector<std::string>& baselines = results.scenario.baselines;
    const auto place = static_cast<std::size_t>(&arm - results.arms.data());
    for (const ArmResults& candidate : results.arms)
        if (place < baselines.size() && candidate.name == baselines[place]) return &candidate;
    return nullptr;
}

Moments aggregate_moments(const ArmResults& arm, std::size_t column) {
    return moments_of(arm.aggregates.columns[column]);
}

DifferenceTotals aggregate_differences(const ScenarioResults& results, const ArmResults& a, const ArmResults& b,
                                       std::size_t column) {
    const auto place = [&](const ArmResults& arm) { return static_cast<std::size_t>(&arm - results.arms.data()); };
    return place(a) > place(b) ? a.aggregates.differences[place(b)][column]
                               : b.aggregates.differences[place(a)][column].reversed();
}

std::vector<ArmAggregates> block_aggregates(const ScenarioResults& results, const Block& block) {
    return results.keep == Keep::trials ? std::vector<ArmAggregates>{} : aggregates_of(results.columns, block);
}

void add_totals(ScenarioResults& results, const Block& block, const std::vector<ArmAggregates>& aggregates) {
    add_scaled_totals(results, block, 1);
    for (std::size_t a = 0; a < aggregates.size(); ++a) results.arms[a].aggregates.add(aggregates[a]);
}

void add_totals(ScenarioResults& results, const Block& block) {
    add_totals(results, block, block_aggregates(results, block));
}

namespace {

void add(ExactSum& to, const ExactSum& from) { to.add(from); }
void add(std::vector<ExactSum>& to, const std::vector<ExactSum>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].add(from[i]);
}
void add(std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from) {
    std::transform(to.begin(), to.end(), from.begin(), to.begin(), std::plus<>());
}

}  // namespace

void add_totals(ArmResults& to, const ArmResults& from) {
    to.counted += from.counted;
    to.aggregates.add(from.aggregates);
    visit_totals([](auto& sum, const auto& other) { add(sum, other); }, to, from);
}

void remove_totals(ScenarioResults& results, const Block& block) {
    add_scaled_totals(results, block, -1);
    const std::vector<ArmAggregates> aggregates = block_aggregates(results, block);
    for (std::size_t a = 0; a < aggregates.size(); ++a) results.arms[a].aggregates.subtract(aggregates[a]);
}

}  // namespace credence
