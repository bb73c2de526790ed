#pragma once
// Module statistics: totals over trials of the columns, for studies whose columns would be too large to store. Means,
// spreads and paired differences follow from them, but no median and no distribution [docs/results-format.md,
// Aggregates].

#include <credence/detail/block.hpp>
#include <credence/detail/exact_sum.hpp>
#include <credence/statistics.hpp>

#include <cstdint>
#include <vector>

namespace credence {

/// Count, sum and sum of squares of values, without any rounding. Values that are NaN are left out.
struct ExactMoments {
    std::int64_t count = 0;
    ExactSum sum, square_sum;

    void add(const ExactMoments& other);
    /// Removes values that were added before, exactly.
    void subtract(const ExactMoments& other);
};

/// mean = S/n and sd = sqrt((n Q - S^2) / (n (n - 1))) of n values of sum S and sum of squares Q; n Q - S^2, in which
/// nearly all digits cancel for values that vary little, is rounded once.
Moments moments_of(const ExactMoments& values);

/// The differences a - b of a column, over the trials that failed in neither arm and have it in both.
struct DifferenceTotals {
    ExactMoments difference;
    std::int64_t below = 0, above = 0;  ///< trials with a < b, and with a > b

    void add(const DifferenceTotals& other);
    void subtract(const DifferenceTotals& other);
    /// b - a instead.
    DifferenceTotals reversed() const;
};

/// The totals of an arm's columns where no trial is kept.
struct ArmAggregates {
    std::vector<std::int64_t> statuses;      ///< [statuses] trials, by how they ended
    std::vector<ExactMoments> columns;       ///< [column_count] over the trials that did not fail; of real columns only
    /// [earlier arms, column_count] this arm minus that one; of real columns only
    std::vector<std::vector<DifferenceTotals>> differences;

    void add(const ArmAggregates& other);
    void subtract(const ArmAggregates& other);
    std::int64_t trials() const;             ///< number of trials, including failed ones
    std::int64_t counted() const;            ///< that did not fail
};

/// Describes an impossible value: a count below 0 or larger than the count that contains it. Nullptr where there is
/// none.
const char* problem_of(const ArmAggregates& aggregates);

/// The aggregates of no trial, by arm.
std::vector<ArmAggregates> empty_aggregates(const std::vector<Column>& columns, std::size_t arms);

/// The aggregates of a block, by arm.
std::vector<ArmAggregates> aggregates_of(const std::vector<Column>& columns, const Block& block);

}  // namespace credence
