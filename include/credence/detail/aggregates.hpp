#pragma once
// Module study: totals over trials of the columns, for studies whose columns would be too large to store. Means,
// spreads and paired differences follow from them, but no median and no distribution [docs/results-format.md,
// Aggregates].

#include <credence/detail/block.hpp>
#include <credence/detail/exact_moments.hpp>

#include <cstdint>
#include <vector>

namespace credence {

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
