#pragma once
// Bounds on the mean of positive numbers, such as NEES/dimension, that hold for heavy tails too
// [docs/theory/statistics.md, Verdict]. Every level is one-sided.

#include <credence/statistics.hpp>

namespace credence {

/// The levels of false findings; together 5 %. Each is shared by all tests of its family (Bonferroni).
namespace levels {
inline constexpr double run = 0.03;          ///< NEES over all steps
inline constexpr double step = 0.0025;       ///< NEES at one step
inline constexpr double direction = 0.015;   ///< directions
inline constexpr double bias = 0.0025;       ///< bias
inline constexpr double acceptance = 0.025;  ///< each side of an acceptance, not shared: all acceptances must hold
}  // namespace levels

/// The level of group g of `groups`: half for the whole state (group 0), half equally among the others; all, for one.
double level_of_group(double level, int g, int groups);

/// What is known of N positive numbers.
struct PositiveSample {
    double trials = 0, mean = 0, standard_deviation = 0;  ///< N; sd with N - 1
    double largest = 0;                                   ///< of those seen
};

PositiveSample positive_sample(const Moments& moments, double largest);

/// A trial that was not seen may have a squared error of so many times the mean (three sigma): for findings. For
/// acceptances the largest that was seen counts, which is 0 here.
inline constexpr double unseen_size = 9;

/// Upper bound, at confidence 1 - level, of the share of trials of which none was seen in N: 1 - level^(1/N).
double unseen_share(double level, double trials);

/// m - t(level, N - 1) s / sqrt(N), and the same upwards. Infinite for one trial.
double lower_bound(const PositiveSample& sample, double level);
double students_upper_bound(const PositiveSample& sample, double level);

/// Student's upper bound, and what the unseen share adds if each of its trials is as large as the largest seen, or as
/// `size` times the mean: without a bound on what was not seen, the mean of positive numbers has no upper bound
/// [Bahadur and Savage 1956; Anderson 1969].
double upper_bound(const PositiveSample& sample, double level, double size);

/// What can be said of a mean that should be 1.
struct MeanClaim {
    Interval bounds;     ///< lower_bound to upper_bound with unseen_size
    bool above = false;  ///< above 1 + margin: a finding
    bool below = false;  ///< below 1 - margin: a finding
    bool tails = false;  ///< below 1 - margin, were it not for trials that were not seen
};

/// NEES/dimension of `degrees` of freedom in all its trials. Student's interval is too narrow for few trials, because
/// chi-square is skewed: the mean must also be beyond the exact bound for NEES distributed as (1 -+ margin) chi-square.
MeanClaim claim_on_nees(const PositiveSample& sample, double degrees, double level, double margin);

/// The same for one number per trial of any distribution, from 200 trials on.
MeanClaim claim_on_mean(const PositiveSample& sample, double level, double margin);

/// Degrees of freedom of the NEES over all steps of N trials, from its spread, 2 N m^2/s^2: at least those of one step
/// and at most those of all, N d to N d K.
double degrees_over_steps(const PositiveSample& sample, int dimension, double steps);

/// Whether the mean is shown to lie within 1 -+ margin at 95 %, and if not, what is in the way.
enum class Acceptance { shown, more_trials, tails };
Acceptance accept_mean(const PositiveSample& sample, double margin);

/// The smallest margin for which the latter is shown.
double margin_shown(const PositiveSample& smallest, const PositiveSample& largest);

/// The same of all means from that of `smallest` to that of `largest`.
Acceptance accept_means(const PositiveSample& smallest, const PositiveSample& largest, double margin);

}  // namespace credence
