#pragma once
// Goodness of fit: is NEES distributed as chi-square, and are shares as they should be? Every null hypothesis here is
// fully specified: no parameter is estimated from the values.

#include <credence/statistics.hpp>
#include <cstdint>
#include <vector>

namespace credence {

/// Wilson's interval of a share, without a correction for continuity [Wilson 1927]: all p for which
/// |successes/trials - p| <= z sqrt(p (1 - p) / trials), z = z_{1-alpha/2}. It starts at 0 where nothing succeeded and
/// ends at 1 where all did. 0 <= successes <= trials; {NaN, NaN} for no trials.
Interval wilson_interval(double successes, double trials, double alpha = 0.05);

/// Upper bound, at confidence 1 - level and one-sided, on a share of which `count` of `trials` were seen [Clopper and
/// Pearson 1934]; NaN without trials.
double share_upper_bound(double count, double trials, double level);

/// Band that holds the mean of independent chi-square values over their mean degrees with probability 1 - alpha:
/// {quantile alpha/2, quantile 1 - alpha/2} of chi-square(degrees), over `degrees`, their degrees added up: N dim for
/// ANEES [Bar-Shalom, Li, Kirubarajan 2001, 5.4.2], sum of m_i for NIS.
Interval chi_square_band(double degrees, double alpha);

/// P(X >= statistic), X ~ chi-square(degrees). NaN for a NaN or degrees <= 0.
double chi_square_p(double statistic, double degrees);

/// Greatest distance of the distribution of probabilities F(x) from the uniform one, sup |F_N(x) - F(x)| [Kolmogorov,
/// Smirnov]; F may be another distribution function for each value x. NaN values are left out; NaN if none is left.
double uniform_distance(std::vector<double> probabilities);

/// The same from counts in `cells` cells of equal probability, from the lowest values to the highest: max over i |share
/// in the first i cells - i/cells|. At most the exact distance, and below it by at most 1/cells. NaN where there are no
/// counts.
double cell_distance(const std::int64_t* counts, int cells);

/// P(D_n >= distance) for the two-sided Kolmogorov-Smirnov distance of n = `count` independent values from their true,
/// continuous distribution. `count` is a whole number, at least 1 (else NaN), of any size: at most a few ms.
///
/// Methods as selected by Simard and L'Ecuyer [Computing the Two-Sided Kolmogorov-Smirnov Distribution, 2011]. Exact up
/// to n = 140, but for rounding (relative error below 1e-9). Beyond, a relative error below 2e-6 where n d^2 > 2.2,
/// from counting twice what is off on both sides; else an absolute one below 0.06 / n^2.
double kolmogorov_smirnov_p(double distance, double count);

}  // namespace credence
