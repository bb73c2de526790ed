#pragma once
// Room 10: the results of a study in memory: what blocks add up to. It knows columns and figures by declaration only.

#include <credence/block.hpp>
#include <credence/exact_sum.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// Totals over trials of one declared figure.
struct FigureTotals {
    std::vector<ExactSum> sum;         ///< [K - 1] over the trials that did not fail
    std::vector<ExactSum> square_sum;  ///< [K - 1]; empty for integer figures
    ExactSum run_square_sum;           ///< of (sum over the steps of one trial), squared
};

/// One arm of a scenario: per-trial columns and per-step totals.
struct ArmResults {
    std::string name;
    std::vector<std::vector<double>> columns;  ///< [column_count][trials]; NaN or fill where a trial failed
    std::vector<FigureTotals> totals;          ///< [figure_count]
    std::int64_t counted = 0;                  ///< trials in the totals: those that did not fail
};

struct ScenarioResults {
    Scenario scenario;                         ///< resolved
    std::vector<Column> columns;
    std::vector<Figure> figures;
    std::vector<ArmResults> arms;
    std::int64_t trials = 0;                   ///< 0 ... trials - 1 are there

    int steps() const { return scenario.poses - 1; }
};

/// An empty result of a resolved scenario.
ScenarioResults empty_results(const Scenario& scenario);

/// Makes room in the columns for trials up to `trials`.
void extend(ScenarioResults& results, std::int64_t trials);

/// Adds a block's totals, and its columns at their trials. Columns of different blocks may be stored from several
/// threads at once; totals may not.
void store_columns(ScenarioResults& results, const Block& block);
void add_totals(ScenarioResults& results, const Block& block);

/// Takes a block's totals back, exactly: a partial last block is computed again when a study grows.
void remove_totals(ScenarioResults& results, const Block& block);

}  // namespace credence
