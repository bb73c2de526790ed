#pragma once
// Module statistics: statistics of a sample of trials, and of pairs of trials. Every value is one trial's; trials are
// independent.

#include <cstdint>
#include <vector>

namespace credence {

struct Interval {
    double low = 0, high = 0;
};

/// Two-sided quantiles: P(|T| <= q) = 1 - alpha for Student's t with `degrees` of freedom, and for the standard normal.
/// Infinity where there is no degree of freedom.
double t_quantile(double alpha, double degrees);
double normal_quantile(double alpha);

/// Quantile of chi-square with `degrees` of freedom below which `p` of it lies, and the one above which `p` lies.
double chi_square_quantile(double p, double degrees);
double chi_square_upper_quantile(double p, double degrees);

/// Mean, standard error and t interval of independent values; NaN where there are too few.
struct Summary {
    std::int64_t count = 0;
    double mean = 0;
    double standard_error = 0;      ///< sd / sqrt(count)
    Interval ci95;                  ///< mean -+ t_{0.975, count - 1} standard_error
    double median = 0;              ///< type 7
    double standard_deviation = 0;  ///< with count - 1
};

/// Of values; those that are NaN are left out. Mean and spread are those of their exact sums [moments_of].
Summary summarise(std::vector<double> values);

/// Quantile of type 7 [Hyndman and Fan 1996] of values without NaN, 0 <= p <= 1; reorders them. NaN for no values.
double quantile(std::vector<double>& values, double p);

/// Share of values below `x`, ties counted half (mid-rank), in percent. NaN values are left out.
double percentile_of(const std::vector<double>& values, double x);

/// Mean and spread from sums alone: of `count` values with sum and sum of squares.
struct Moments {
    double count = 0, mean = 0, standard_deviation = 0, standard_error = 0;
};
/// mean -+ t_{1 - alpha/2, count - 1} standard_error
Interval t_interval(const Moments& moments, double alpha = 0.05);

/// Two-sided p-value of Student's test that the mean is exactly `expected`; NaN for fewer than two values.
double t_test(const Moments& moments, double expected);
/// The part of a summary that follows from sums: the median is NaN.
Summary summary_of(const Moments& moments);
Moments moments_from_sums(std::int64_t count, double sum, double square_sum);

}  // namespace credence
