#pragma once
// Room 10: the results of a study in memory: what blocks add up to. It knows columns and figures by declaration only.

#include <credence/block.hpp>
#include <credence/exact_sum.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// Totals over trials of one declared figure.
struct FigureTotals {
    std::vector<ExactSum> sum;         ///< [K - 1] over the trials that did not fail
    std::vector<ExactSum> square_sum;  ///< [K - 1]; empty for integer figures
    ExactSum run_square_sum;           ///< of (sum over the steps of one trial), squared
    std::optional<ExactSum> run_sum;   ///< of the sum over the steps of one trial; none: the sum of `sum`
    std::vector<std::int64_t> covered; ///< [K - 1, levels] of a nees: trials below the quantile of chi-square; else empty
};

/// Totals over the detailed trials of products of whitened innovations, by lag from 1 up.
struct ProductTotals {
    std::vector<ExactSum> sum;
    std::vector<ExactSum> square_sum;  ///< of each trial's sum, squared
    std::vector<std::int64_t> count;   ///< products
};

/// One arm of a scenario: per-trial columns and per-step totals.
struct ArmResults {
    std::string name;
    std::vector<std::vector<double>> columns;  ///< [column_count][trials]; NaN or fill where a trial failed
    std::vector<FigureTotals> totals;          ///< [figure_count]
    std::int64_t counted = 0;                  ///< trials in the totals: those that did not fail
    std::vector<std::int64_t> cells;           ///< [K - 1, shape_cells] trials by cell of the first nees figure
    ProductTotals products;
    std::vector<double> errors;                ///< [detailed trials, K - 1, n], NaN where there is none
    std::vector<double> nees;                  ///< [detailed trials, K - 1] of the first nees figure, NaN likewise

    // Of a record only: runs may differ in length there, and its values are at hand.
    std::vector<std::int64_t> present;         ///< [K - 1] trials that have the step; empty: all that are counted
    std::vector<double> shape_distance;        ///< [K - 1] exact distance of the NEES from chi-square; empty: by cells

    std::int64_t counted_at(std::size_t step) const { return present.empty() ? counted : present[step]; }
};

struct ScenarioResults {
    Scenario scenario;                         ///< resolved
    std::vector<Column> columns;
    std::vector<Figure> figures;
    std::vector<ArmResults> arms;
    std::int64_t trials = 0;                   ///< 0 ... trials - 1 are there

    int steps() const { return scenario.poses - 1; }
    /// Trials whose errors are kept.
    std::int64_t detailed() const {
        const int most = detailed_trials(steps(), state_size());
        return trials < most ? trials : most;
    }
    /// n
    int state_size() const { return figures.front().dimension; }
};

/// An empty result of a resolved scenario.
ScenarioResults empty_results(const Scenario& scenario);

/// Whether a column is a figure of the trial, not its status.
bool is_figure(const Column& column);

/// A column's values, failed trials as NaN whatever their fill.
std::vector<double> figure_values(const ArmResults& arm, std::size_t column);

/// The arms that a name means: the one that has it, or all of that controller.
std::vector<const ArmResults*> arms_meant(const ScenarioResults& results, const std::string& name);

/// `fixed.X` beside `greedy.X`; nullptr where there is none, or where the arm is no greedy one.
const ArmResults* fixed_partner(const ScenarioResults& results, const ArmResults& arm);

/// Makes room in the columns for trials up to `trials`.
void extend(ScenarioResults& results, std::int64_t trials);

/// Adds a block's totals, and its columns at their trials. Columns of different blocks may be stored from several
/// threads at once; totals may not.
void store_columns(ScenarioResults& results, const Block& block);
void add_totals(ScenarioResults& results, const Block& block);

/// Takes a block's totals back, exactly: a partial last block is computed again when a study grows.
void remove_totals(ScenarioResults& results, const Block& block);

}  // namespace credence
