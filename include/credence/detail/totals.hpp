#pragma once
// Module totals: the totals of one arm over its trials, from which everything follows that needs no single trial:
// exact, so that they are the same in whatever order trials were added, and can be merged and taken back.

#include <credence/columns.hpp>
#include <credence/detail/exact_moments.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace credence {

/// Trials by how they ended, and the columns of those that did not fail.
struct TrialTotals {
    std::vector<std::int64_t> statuses;      ///< [statuses] trials
    std::vector<ExactMoments> columns;       ///< [column_count] of the columns that are reported
    /// [earlier arms, column_count] of this arm minus that one, over the trials that failed in neither
    std::vector<std::vector<DifferenceTotals>> differences;
    bool diverged_count = false;  ///< diverged trials are in the series as the others

    void add(const TrialTotals& other, int sign = 1);
    std::int64_t trials() const;             ///< number of trials, including failed ones
    std::int64_t counted() const;            ///< those of the series: that did not fail and, as a rule, did not diverge
    std::int64_t diverged() const;           ///< whose columns are known, and whose series are apart as a rule
    std::int64_t finite() const;             ///< that did not fail
};

/// Whether a column is a quantity of the trial, not its status.
bool is_reported(const Column& column);

/// Describes an impossible value: a count below 0 or larger than the count that contains it. Nullptr if there is none.
const char* problem_of(const TrialTotals& totals);

/// The totals of no trial, by arm.
std::vector<TrialTotals> empty_trial_totals(const std::vector<Column>& columns, std::size_t arms);

/// The totals of some trials, by arm; `all(arm, column)` has the column's values of all of them, failed ones included.
std::vector<TrialTotals> trial_totals(const std::vector<Column>& columns, std::size_t arms, std::size_t trials,
                                      const std::function<const double*(std::size_t arm, std::size_t column)>& all);

/// Totals over trials of one declared series.
struct SeriesTotals {
    std::vector<ExactSum> sum;         ///< [K - 1] over the trials that count
    std::vector<ExactSum> square_sum;  ///< [K - 1]; empty for integer series
    ExactSum run_square_sum;           ///< of (sum over the steps of one trial), squared
    std::optional<ExactSum> run_sum;   ///< of the sum over the steps of one trial; none: the sum of `sum`
    /// [K - 1, levels] of a nees: trials below the quantile of chi-square; else empty.
    std::vector<std::int64_t> covered;

    // Of a record only, in which a component group may be missing at some steps of a trial.
    std::vector<std::int64_t> present{};  ///< [K - 1] trials with a value at the step; empty: as the arm says
    std::int64_t runs = 0;                ///< trials with a value at some step; means only something beside `present`
    /// [K - 1] of the NEES of a state that grows or shrinks: the dimensions that it has at the step, added up over the
    /// trials; empty: each has the declared one. `sum` and `square_sum` are then of NEES / (dimension at the step)
    /// times the declared dimension.
    std::vector<std::int64_t> dimensions{};

    /// Adds the totals of other trials, or takes them back.
    void add(const SeriesTotals& other, int sign = 1);
};

/// Totals over the detailed trials of products of whitened innovations, by lag from 1 up.
struct ProductTotals {
    std::vector<ExactSum> sum;
    std::vector<ExactSum> square_sum;  ///< of each trial's sum, squared
    std::vector<std::int64_t> count;   ///< products
};

/// All totals of one arm.
struct Totals {
    TrialTotals trials;
    std::vector<SeriesTotals> series;          ///< [series_count] over the trials that the verdict counts
    std::vector<SeriesTotals> diverged;        ///< [series_count] over diverged ones apart; empty where there are none
    std::vector<std::int64_t> cells;           ///< [K - 1, distribution_cells] trials by cell of the first nees series
    ProductTotals products;

    // Of a record only, whose runs may differ in length.
    std::vector<std::int64_t> present;         ///< [K - 1] trials that have the step; empty: all counted ones have
    /// [K - 1] exact distance of the NEES from chi-square; empty: by cells.
    std::vector<double> distribution_distance;
    /// [groups] at the worst step, the mean over the trials of what rounding may have done to NEES; empty: unknown.
    std::vector<double> rounding;

    /// `diverged`, with totals of no trial where it was empty.
    std::vector<SeriesTotals>& of_diverged();
    /// `series` and `diverged` together.
    std::vector<SeriesTotals> of_finite() const;

    std::int64_t counted_at(std::size_t step) const { return present.empty() ? trials.counted() : present[step]; }
    /// Trials with a value of the series at a step, and at some step.
    std::int64_t counted_at(const SeriesTotals& one, std::size_t step) const {
        return one.present.empty() ? counted_at(step) : one.present[step];
    }
    std::int64_t counted_in(const SeriesTotals& one) const { return one.present.empty() ? trials.counted() : one.runs; }
};

}  // namespace credence
