#include "files/results/agreement.hpp"

#include <credence/error.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace credence {

namespace {

/// The steps over which a series adds up to a column: all, or the last one alone.
enum class Steps { all, last };

/// A column that has for each trial what the totals of a series have for all trials.
struct Relation {
    std::size_t column, series;
    Steps steps;
    double per;  ///< the column times this is the sum of the series over those steps
};

std::optional<std::size_t> series_of(const ScenarioResults& results, SeriesRole role, const std::string& part) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].role == role && results.all_series[f].part == part) return f;
    return std::nullopt;
}

std::optional<std::size_t> series_named(const ScenarioResults& results, const std::string& name) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].name == name) return f;
    return std::nullopt;
}

/// The pairs of columns and series that several worlds have, as far as this one has them.
std::vector<Relation> relations(const ScenarioResults& results) {
    std::vector<Relation> all;
    const auto add = [&](const std::string& name, std::optional<std::size_t> series, Steps steps, double per) {
        for (std::size_t c = 0; c < results.columns.size() && series; ++c)
            if (results.columns[c].name == name) all.push_back({c, *series, steps, per});
    };
    const std::optional<std::size_t> variance = series_of(results, SeriesRole::variance, "all");
    add("nees_ratio", 0, Steps::all, static_cast<double>(results.steps()) * results.state_size());
    add("mean_trace_P", variance, Steps::all, results.steps());
    add("trace_P", variance, Steps::last, 1);
    add("unseen", series_named(results, "unseen_features"), Steps::all, 1);
    add("squared_error", series_of(results, SeriesRole::squared_error, "all"), Steps::all, 1);
    return all;
}

/// Sums over the trials that did not fail.
struct Sums {
    double value = 0, square = 0;
};

Sums sums_of_column(const ScenarioResults& results, const ArmResults& arm, std::size_t column) {
    if (results.keep == Keep::aggregates) {
        const ExactMoments& moments = arm.aggregates.columns[column];
        return {moments.sum.rounded(), moments.square_sum.rounded()};
    }
    constexpr std::int64_t at_once = std::int64_t{1} << 16;
    const std::size_t status = status_column(results.columns);
    Sums sums;
    for (std::int64_t first = 0; first < results.trials; first += at_once) {
        const std::int64_t count = std::min(at_once, results.trials - first);
        const std::vector<double> values = column_values(arm, column, first, count),
                                  ends = column_values(arm, status, first, count);
        Sums some;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (failed(static_cast<Status>(static_cast<int>(ends[i])))) continue;
            some.value += values[i];
            some.square += values[i] * values[i];
        }
        sums.value += some.value;
        sums.square += some.square;
    }
    return sums;
}

/// The same of the series; `square` only where the column is its sum over all steps.
Sums sums_of_series(const SeriesTotals& totals, Steps steps) {
    if (steps == Steps::last) return {totals.sum.back().rounded(), totals.square_sum.back().rounded()};
    ExactSum sum;
    for (const ExactSum& step : totals.sum) sum.add(step);
    return {sum.rounded(), totals.run_square_sum.rounded()};
}

/// The columns are rounded, so their sums are; values that are not finite are not compared.
bool agree(double column, double series) {
    constexpr double tolerance = 1e-9;
    return !std::isfinite(column) || !std::isfinite(series) ||
           std::abs(column - series) <= tolerance * std::abs(column);
}

void check_arm(const ScenarioResults& results, const ArmResults& arm, const std::string& path) {
    for (const Relation& relation : relations(results)) {
        const Sums column = sums_of_column(results, arm, relation.column),
                   series = sums_of_series(arm.totals[relation.series], relation.steps);
        if (agree(column.value * relation.per, series.value) &&
            agree(column.square * relation.per * relation.per, series.square))
            continue;
        throw InputError(path + ": /" + results.scenario.name + "/" + arm.name + ": the totals of " +
                         results.all_series[relation.series].name + " are not those of the trials' " +
                         results.columns[relation.column].name + ". Run the study again, or give an undamaged copy.");
    }
}

}  // namespace

void check_agreement(const ScenarioResults& results, const std::string& path) {
    const WithTotals with_totals(results);
    for (const ArmResults& arm : (*with_totals).arms) check_arm(*with_totals, arm, path);
}

void check_agreement(const Study& study, const std::string& path) {
    for (const ScenarioResults& results : study.scenarios) check_agreement(results, path);
}

}  // namespace credence
