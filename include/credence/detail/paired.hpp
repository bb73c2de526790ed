#pragma once
// Module statistics: two arms compared by trial, as pairs: all arms of a trial share their noise. [docs/statistics.md,
// Comparison]

#include <credence/detail/exact_moments.hpp>
#include <credence/detail/histogram.hpp>
#include <credence/statistics.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace credence {

/// The fewest pairs without which a mean difference would have the sign of the median, where the two differ.
struct CarryingPairs {
    std::int64_t count = 0;            ///< 0: mean and median do not differ in sign
    std::vector<std::int64_t> first{};  ///< up to five with the largest differences: indices of pairs, from 0 on
};

/// The comparison of arm A with arm B by the pairs (a_i, b_i). NaN where there are too few pairs.
struct PairedComparison {
    std::int64_t pairs = 0;         ///< trials in which neither arm failed
    double mean_a = 0, mean_b = 0;  ///< over the pairs
    Summary difference;             ///< of a - b: mean, t interval, median
    Interval bootstrap95;           ///< of the mean difference
    double wins_a = 0, wins_b = 0;  ///< share of pairs in which the arm has the smaller value
    double ties = 0;                ///< share of pairs with equal values
    double wilcoxon_z = 0;          ///< signed-rank score, negative where a tends to be smaller; NaN if all are ties
    double wilcoxon_p = 0;          ///< two-sided; 1 if all pairs are ties
    double sign_p = 0;              ///< of the sign test, two-sided; 1 if all pairs are ties
    CarryingPairs carrying{};       ///< those that carry the mean; in a Comparison by trial
    double effect_size = 0;         ///< d_z = mean / sd of the differences [Cohen 1988, 2.3.5]
    double variance_reduction = 0;  ///< (V_A + V_B) / V_{A-B}, the gain by common random numbers
    Histogram histogram;            ///< of a - b
};

/// Compares values by trial, `a[i]` and `b[i]` those of trial i; a trial with a NaN in either is left out.
///
/// Wilcoxon's signed-rank test [Hollander and Wolfe 1999, 3.1]: differences of 0 are dropped, n stay; W is the sum of
/// the ranks of |d| over the positive d, equal |d| sharing their average rank; without a correction for continuity
///   z = (W - n(n+1)/4) / sqrt(n(n+1)(2n+1)/24 - sum (t^3 - t)/48), t the sizes of the groups of equal |d|.
///
/// Where all differences are equal, the variance reduction is infinite (NaN if neither arm varies), and d_z is infinite
/// too (NaN for differences of 0). Draws of the bootstrap are keyed by `root_seed` and the name of the column.
PairedComparison compare_paired(const std::vector<double>& a, const std::vector<double>& b, std::uint64_t root_seed,
                                const std::string& column);

/// The same from totals: mean, t interval, shares of wins and d_z; values that need the trials are NaN, the histogram
/// empty. The means of the arms and the variance reduction are known if every trial of `a` and `b`, the values of the
/// arms by themselves, is in a pair.
PairedComparison compare_totals(const DifferenceTotals& totals, const ExactMoments& a, const ExactMoments& b);

/// Two-sided p-value of the sign test, exact: that of `below` and `above` differences with that sign, ties dropped
/// [Hollander and Wolfe 1999, 3.4].
double sign_test(std::int64_t below, std::int64_t above);

/// Two-sided p-value of Fisher's exact test that `a` of `of_a` and `b` of `of_b` are of one share: all tables of the
/// same sums that are not more probable.
double fisher_exact(std::int64_t a, std::int64_t of_a, std::int64_t b, std::int64_t of_b);

/// p-values adjusted for their number [Holm 1979], in the order given: with p_(1) <= ... <= p_(m),
/// max over j <= i of min(1, (m - j + 1) p_(j)). NaN stays NaN and does not count.
std::vector<double> holm(std::vector<double> p);

}  // namespace credence
