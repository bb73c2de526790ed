#pragma once
// Module statistics: count, sum and sum of squares of values, without any rounding: the same in whatever order and
// parts the values come.

#include <credence/detail/exact_sum.hpp>
#include <credence/statistics.hpp>

#include <cstdint>
#include <vector>

namespace credence {

/// Count, sum and sum of squares of values. Values that are NaN are left out.
struct ExactMoments {
    std::int64_t count = 0;
    ExactSum sum, square_sum;

    /// Adds other values, or removes ones that were added before, exactly.
    void add(const ExactMoments& other, int sign = 1);
};

ExactMoments exact_moments(const std::vector<double>& values);

/// mean = S/n and sd = sqrt((n Q - S^2) / (n (n - 1))) of n values of sum S and sum of squares Q; n Q - S^2, in which
/// nearly all digits cancel for values that vary little, is rounded once.
Moments moments_of(const ExactMoments& values);

/// Differences a - b by trial, over the trials that have both.
struct DifferenceTotals {
    ExactMoments difference;
    std::int64_t below = 0, above = 0;  ///< trials with a < b, and with a > b

    void add(const DifferenceTotals& other, int sign = 1);
    /// b - a instead.
    DifferenceTotals reversed() const;
};

/// Of `a` and `b` by trial, of the same size.
DifferenceTotals differences_of(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace credence
