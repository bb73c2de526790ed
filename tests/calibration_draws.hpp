#pragma once
// NumPy's normal draws (tests/reference/make_chi_square.py) as the results of a filter: totals put together by hand, as
// the engine would have folded them.

#include "numeric/chi_square.hpp"
#include <credence/evidence.hpp>

#include "reference.hpp"

namespace credence::test {

namespace drawn {

inline constexpr std::size_t trials = 200, steps = 5, n = 4, rows = 4, lags = 4;
inline constexpr std::size_t row_series = 4;  ///< NEES of three groups, NIS, its rows ...

inline const Json& expected() {
    static const Json values = Json::parse(std::ifstream(CREDENCE_SOURCE "/tests/reference/chi_square.json"));
    return values;
}

inline const std::vector<ComponentGroup>& blocks() {
    static const std::vector<ComponentGroup> blocks{{"all", 0, 4}, {"pose", 0, 2}, {"features", 2, 2}};
    return blocks;
}

inline std::vector<Series> figures() {
    std::vector<Series> figures;
    const auto add = [&](SeriesRole role, int dimension, const std::string& part) {
        figures.push_back({"figure_" + std::to_string(figures.size()), "", "1", role, dimension, false, part, "", 0});
    };
    for (const ComponentGroup& block : blocks()) add(SeriesRole::nees, block.count, block.name);
    add(SeriesRole::nis, 0, "all");
    figures.back().rows = "figure_" + std::to_string(row_series);
    add(SeriesRole::rows, 0, "all");
    figures.back().integer = true;
    for (const ComponentGroup& block : blocks()) add(SeriesRole::squared_error, block.count, block.name);
    for (const ComponentGroup& block : blocks()) add(SeriesRole::variance, block.count, block.name);
    for (std::size_t j = 0; j < n; ++j) add(SeriesRole::standardised_error, 1, std::to_string(j));
    return figures;
}

/// One trial's values [steps, series], in their order. P = claimed sigma^2 I, S = I.
inline std::vector<std::vector<double>> trial_values(const double* draws, const double* innovations, double claimed) {
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < steps; ++k) {
        const double sigma = expected()["sigma"][k];
        std::vector<double> nees, squares, variances, standardised;
        for (const ComponentGroup& block : blocks()) {
            double sum = 0;
            for (int j = block.first; j < block.first + block.count; ++j) sum += draws[k * n + j] * draws[k * n + j];
            nees.push_back(sum / claimed);
            squares.push_back(sum * sigma * sigma);
            variances.push_back(block.count * claimed * sigma * sigma);
        }
        for (std::size_t j = 0; j < n; ++j) standardised.push_back(draws[k * n + j] / std::sqrt(claimed));
        double nis = 0, seen = 0;
        for (std::size_t r = 0; r < rows; ++r) {
            const double innovation = innovations[k * rows + r];
            if (std::isnan(innovation)) continue;
            nis += innovation * innovation;
            ++seen;
        }
        std::vector<double> all = nees;
        all.insert(all.end(), {nis, seen});
        for (const auto& more : {squares, variances, standardised}) all.insert(all.end(), more.begin(), more.end());
        values.push_back(all);
    }
    return values;
}

/// Adds a trial's values to the totals.
inline void add_trial(const std::vector<std::vector<double>>& values, const std::vector<Series>& figures,
                      ArmResults& arm) {
    for (std::size_t f = 0; f < figures.size(); ++f) {
        SeriesTotals& totals = arm.totals.series[f];
        double run = 0;
        for (std::size_t k = 0; k < steps; ++k) {
            const double value = values[k][f];
            run += value;
            totals.sum[k].add(value);
            if (!figures[f].integer) totals.square_sum[k].add(value * value);
            for (std::size_t level = 0; level * steps < totals.covered.size(); ++level)
                totals.covered[k * coverage_level_count + level] +=
                    value < stable_chi_square_quantile(coverage_levels[level], figures[f].dimension);
        }
        totals.run_square_sum.add(run * run);
    }
    for (std::size_t k = 0; k < steps; ++k) {
        arm.nees.push_back(values[k][0]);
        ++arm.totals
              .cells[k * distribution_cells + static_cast<std::size_t>(equiprobable_cells(n)->cell(values[k][0]))];
    }
    ++arm.totals.trials.statuses[static_cast<std::size_t>(Status::completed)];
}

inline void add_products(const double* innovations, ProductTotals& products) {
    for (std::size_t lag = 1; lag <= lags; ++lag)
        for (std::size_t at = 0; at + lag * rows < steps * rows; ++at) {
            const double product = innovations[at] * innovations[at + lag * rows];
            if (std::isnan(product)) continue;
            products.sum[lag - 1].add(product);
            ++products.count[lag - 1];
        }
}

/// The results of a filter that claims `claimed` times the covariance that its errors have.
inline ScenarioResults results(double claimed) {
    const std::vector<double> draws = numbers(expected()["draws"]), innovations = numbers(expected()["innovations"]);
    Scenario scenario;
    scenario.poses = steps + 1;
    ScenarioResults results{scenario, status_columns(), figures(), {}, trials};
    ArmResults arm;
    for (const Column& column : results.columns) arm.columns.in_memory().emplace_back(trials, column.fill);
    for (const Series& figure : results.all_series)
        arm.totals.series.push_back(
            {std::vector<ExactSum>(steps),
             std::vector<ExactSum>(figure.integer ? 0 : steps),
             {},
             {},
             std::vector<std::int64_t>(figure.role == SeriesRole::nees ? steps * coverage_level_count : 0)});
    arm.totals.trials = empty_trial_totals(results.columns, 1).front();
    arm.totals.cells.resize(steps * distribution_cells);
    arm.totals.products = {std::vector<ExactSum>(lags), std::vector<ExactSum>(lags), std::vector<std::int64_t>(lags)};
    for (std::size_t i = 0; i < trials; ++i) {
        const double* seen = innovations.data() + i * steps * rows;
        add_trial(trial_values(draws.data() + i * steps * n, seen, claimed), results.all_series, arm);
        add_products(seen, arm.totals.products);
    }
    for (std::size_t i = 0; i < draws.size(); ++i)
        arm.errors.push_back(draws[i] * expected()["sigma"][i / n % steps].get<double>());
    results.arms.push_back(arm);
    return results;
}

}  // namespace drawn

}  // namespace credence::test
