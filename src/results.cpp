#include <credence/results.hpp>

#include <algorithm>

namespace credence {

namespace {

void add_scaled_totals(ScenarioResults& results, const Block& block, double sign) {
    const std::size_t steps = static_cast<std::size_t>(results.steps());
    for (std::size_t a = 0; a < results.arms.size(); ++a) {
        const ArmBlock& from = block.arms[a];
        ArmResults& to = results.arms[a];
        to.counted += static_cast<std::int64_t>(sign) * from.counted;
        for (std::size_t f = 0; f < results.figures.size(); ++f) {
            FigureTotals& totals = to.totals[f];
            totals.run_square_sum.add(sign * from.run_square_sums[f]);
            for (std::size_t k = 0; k < steps; ++k) {
                totals.sum[k].add(sign * from.sums[f * steps + k]);
                if (!results.figures[f].integer) totals.square_sum[k].add(sign * from.square_sums[f * steps + k]);
            }
        }
    }
}

}  // namespace

ScenarioResults empty_results(const Scenario& scenario) {
    ScenarioResults results{scenario, trial_columns(scenario), step_figures(scenario), {}, 0};
    const std::size_t steps = static_cast<std::size_t>(results.steps());
    for (const Arm& arm : arms_of(scenario)) {
        ArmResults one{arm_name(arm), std::vector<std::vector<double>>(results.columns.size()), {}, 0};
        for (const Figure& figure : results.figures)
            one.totals.push_back({std::vector<ExactSum>(steps), std::vector<ExactSum>(figure.integer ? 0 : steps), {}});
        results.arms.push_back(std::move(one));
    }
    return results;
}

void extend(ScenarioResults& results, std::int64_t trials) {
    for (ArmResults& arm : results.arms)
        for (std::vector<double>& column : arm.columns) column.resize(static_cast<std::size_t>(trials));
    results.trials = trials;
}

void store_columns(ScenarioResults& results, const Block& block) {
    for (std::size_t a = 0; a < results.arms.size(); ++a)
        for (std::size_t c = 0; c < results.columns.size(); ++c) {
            const auto from = block.arms[a].columns.begin() + static_cast<std::ptrdiff_t>(c) * block.trials;
            std::copy(from, from + block.trials, results.arms[a].columns[c].begin() + block.index * block_size);
        }
}

void add_totals(ScenarioResults& results, const Block& block) { add_scaled_totals(results, block, 1); }

void remove_totals(ScenarioResults& results, const Block& block) { add_scaled_totals(results, block, -1); }

}  // namespace credence
