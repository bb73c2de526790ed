#pragma once
// The correlation of whitened innovations a number of measurements apart, by trials [docs/statistics.md, Whiteness].

#include <credence/statistics.hpp>
#include <optional>

namespace credence {

/// Least number of products for a test: a sum of fewer is far from normal.
inline constexpr double least_products = 30;

/// Sums over the trials of one lag and group of rows. p: the sum of a trial's products; c: their number, not 0.
struct LagSums {
    double trials = 0;             ///< that have products
    double p = 0, pp = 0, pc = 0;  ///< of p, p^2, p c
    double c = 0, cc = 0;          ///< of c, c^2
    double product_squares = 0;    ///< of the single products' squares, over all trials; for few trials only

    void add(double sum, double count, double squares = 0);
};

struct LagCorrelation {
    double r = 0;       ///< mean product
    Interval interval;  ///< two-sided
};

/// Nothing for fewer than 30 products. The interval rests on the spread of the trials, because heavy tails of one scale
/// a trial make its products vary together: Student's, of y = r + (p - r c) / mean c. Of one trial it is z times the
/// root of product_squares over c, and of 2 to 7 trials the wider of both. `alpha` is two-sided, corrected for all lags
/// and groups that are tested.
std::optional<LagCorrelation> correlation_of(const LagSums& sums, double alpha);

}  // namespace credence
