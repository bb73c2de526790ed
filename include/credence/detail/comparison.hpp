#pragma once
// Module verdict: arms compared by trial: planned against fixed, one estimator against another, one study against
// another that shares its draws [docs/statistics.md, Comparison].

#include <credence/detail/paired.hpp>
#include <credence/detail/results.hpp>

#include <string>
#include <vector>

namespace credence {

/// One per-trial column of both arms.
struct ComparedColumn {
    std::string name, unit;
    PairedComparison paired;
    double holm_p = 0;      ///< Wilcoxon's p, corrected for everything that was compared with it
    ColumnPlaces places{};
};

/// Arm a minus arm b, over the trials that both have.
struct Comparison {
    std::string scenario, a, b;
    std::vector<ComparedColumn> columns;    ///< the columns that are compared, in their order

    std::string name() const { return a + " - " + b; }
};

/// An arm and its name in the comparison.
struct ComparedArm {
    const ScenarioResults& results;
    const ArmResults& arm;
    std::string label;
};

/// The trials that two results of the same world both have.
class CommonTrials {
public:
    CommonTrials(const ScenarioResults& a, const ScenarioResults& b);
    std::int64_t count() const { return count_; }
    /// The row of `a` that has the common trial of that place.
    std::int64_t row_of_a(std::int64_t place) const;
    /// The values of the common trials, from one value a trial of `a` or of `b`.
    std::vector<double> of_a(const std::vector<double>& values) const { return selected(values, &Span::a); }
    std::vector<double> of_b(const std::vector<double>& values) const { return selected(values, &Span::b); }

private:
    /// Rows that are adjacent in both.
    struct Span {
        std::int64_t a, b, rows;
    };
    std::vector<double> selected(const std::vector<double>& values, std::int64_t Span::* first) const;

    std::vector<Span> spans_;
    std::int64_t count_ = 0;
};

/// Compares two arms that share their draws, trial by trial. `root_seed` keys the bootstrap. Where no trial is kept,
/// the arms must be of the same results, and the comparison is computed from their totals.
Comparison compare_arms(const ComparedArm& a, const ComparedArm& b, std::uint64_t root_seed);

/// Sets holm_p for all columns of all comparisons.
void correct_together(std::vector<Comparison>& comparisons);

/// Every planned arm against its baseline: greedy - fixed of the same estimator, horizon - greedy.
std::vector<Comparison> planned_against_baselines(const std::vector<ScenarioResults>& scenarios,
                                                  std::uint64_t root_seed);

}  // namespace credence
