#include "study/block_results.hpp"

#include "numeric/chi_square.hpp"

#include <credence/detail/worlds.hpp>
#include <credence/error.hpp>

#include <algorithm>

namespace credence {

namespace {

void add_figure(SeriesTotals& totals, const Series& series, const SeriesSums& from, std::size_t f, std::size_t steps,
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

void add_series(std::vector<SeriesTotals>& to, const ScenarioResults& results, const SeriesSums& from,
                std::int64_t sign) {
    const std::int32_t* covered = from.covered.data();
    for (std::size_t f = 0; f < to.size(); ++f) {
        add_figure(to[f], results.all_series[f], from, f, static_cast<std::size_t>(results.steps()),
                   static_cast<double>(sign));
        add_coverage(to[f], covered, sign);
        covered += to[f].covered.size();
    }
}

void add_cells(Totals& to, const ArmBlock& from, std::size_t trials, std::int64_t sign) {
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
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmBlock& from = block.arms[a];
        Totals& to = results.arms[a].totals;
        add_series(to.series, results, from, sign);
        if (!from.diverged.sums.empty()) add_series(to.of_diverged(), results, from.diverged, sign);
        add_cells(to, from, static_cast<std::size_t>(block.trials), sign);
        add_products(to.products, from, sign);
    }
}


/// Detailed trials of a block, from a row on.
void store_details(const ArmBlock& from, std::int64_t row, std::size_t trials, ArmResults& to) {
    const auto put = [&](const auto& values, std::vector<double>& all) {
        const auto width = static_cast<std::int64_t>(values.size() / trials);
        std::copy(values.begin(), values.end(), all.begin() + row * width);
    };
    put(from.errors, to.errors);
    put(from.nees, to.nees);
    put(from.moments, to.moments);
}

}  // namespace

ScenarioResults results_without_totals(const Scenario& scenario, Keep keep) {
    const World& world = world_of(scenario);
    ScenarioResults results{scenario, world.columns(scenario), world.all_series(scenario), {}, 0, {}, keep};
    name_arms(results);
    for (ArmResults& arm : results.arms)
        if (keep == Keep::trials) arm.columns.in_memory().resize(results.columns.size());
    return results;
}

void require_all_columns(const Study& study, const std::string& cannot) {
    for (const ScenarioResults& results : study.scenarios)
        for (const Column& column : world_of(results.scenario).columns(results.scenario))
            if (std::ranges::find(results.columns, column.name, &Column::name) == results.columns.end())
                throw InputError(cannot, "it has no column " + column.name + ", which trials have since then",
                                 "Report it as it is, or run the study again");
}

ScenarioResults empty_results(const Scenario& scenario, Keep keep) {
    ScenarioResults results = results_without_totals(scenario, keep);
    clear_totals(results);
    return results;
}

std::vector<TrialTotals> trial_totals_of(const ScenarioResults& results, const Block& block) {
    const auto trials = static_cast<std::size_t>(block.trials);
    return trial_totals(results.columns, block.arms.size(), trials, [&](std::size_t arm, std::size_t column) {
        return block.arms[arm].columns.data() + column * trials;
    });
}

void add_totals(ScenarioResults& results, const Block& block, const std::vector<TrialTotals>& of_trials) {
    add_scaled_totals(results, block, 1);
    for (std::size_t a = 0; a < of_trials.size(); ++a) results.arms[a].totals.trials.add(of_trials[a]);
}

void add_totals(ScenarioResults& results, const Block& block) {
    add_totals(results, block, trial_totals_of(results, block));
}

void remove_totals(ScenarioResults& results, const Block& block) {
    add_scaled_totals(results, block, -1);
    const std::vector<TrialTotals> of_trials = trial_totals_of(results, block);
    for (std::size_t a = 0; a < of_trials.size(); ++a) {
        Totals& totals = results.arms[a].totals;
        totals.trials.add(of_trials[a], -1);
        if (totals.trials.diverged() == 0) totals.diverged.clear();
    }
}

void store_columns(ScenarioResults& results, const Block& block) {
    const std::int64_t row = first_row(results, block.index).value();
    const auto trials = static_cast<std::size_t>(block.trials);
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        ArmResults& arm = results.arms[a];
        if (!block.arms[a].nees.empty()) store_details(block.arms[a], row, trials, arm);
        if (arm.columns.kept() || arm.columns.empty()) continue;
        for (std::size_t c = 0; c < results.columns.size(); ++c)
            std::copy_n(block.arms[a].columns.begin() + static_cast<std::ptrdiff_t>(c * trials), trials,
                        arm.columns.in_memory()[c].begin() + row);
    }
}

}  // namespace credence
