#pragma once
// Bounds on the mean of positive numbers, such as NEES/dimension, that hold for heavy tails too
// [docs/theory/statistics.md, Verdict]. Every level is one-sided.

#include <credence/statistics.hpp>

namespace credence {

/// The levels of false findings; together 5 %. Each is shared by all tests of its family (Bonferroni).
namespace levels {
inline constexpr double run = 0.03;          ///< NEES over all steps
inline constexpr double step = 0.00125;      ///< NEES at one step
inline constexpr double calibration = 0.00125;  ///< NEES of a quintile of the trials
inline constexpr double direction = 0.015;   ///< directions
inline constexpr double bias = 0.0025;       ///< bias
inline constexpr double acceptance = 0.025;  ///< each side of an acceptance, not shared: all acceptances must hold
/// That a larger share of trials was missed than findings over the steps and in directions allow for, 2/N: as large as
/// the rates of false findings permit [docs/theory/statistics.md, Calibration and power].
inline constexpr double unseen = 0.135;
inline constexpr double unseen_of_few = 0.01;  ///< of trials of few numbers [PositiveSample]
}  // namespace levels

/// The level of group g of `groups`: half for the whole state (group 0), half equally among the others; all, for one.
double level_of_group(double level, int g, int groups);

/// What is known of N positive numbers.
struct PositiveSample {
    double trials = 0, mean = 0, standard_deviation = 0;  ///< N; sd with N - 1
    /// The largest of them, where they are of segments of runs or of few numbers: beside the unseen share, one more
    /// like it may have been missed. 0: not so.
    double largest = 0;
    /// Each is the mean of so few numbers, steps times components, that the law of small errors matters: a trial that
    /// was not seen may have an error of three sigma by P, however small the others are.
    bool of_few_numbers = false;
};
/// Fewer numbers than these are few.
inline constexpr double many_numbers = 20;

PositiveSample positive_sample(const Moments& moments, double largest = 0);

/// A trial that was not seen may have a squared error of so many times the mean: three sigma.
inline constexpr double unseen_size = 9;

/// Upper bound, at confidence 1 - level, of the share of trials of which none was seen in N: 1 - level^(1/N).
double unseen_share(double level, double trials);

/// m - t(level, N - 1) s / sqrt(N), and the same upwards. Infinite for one trial. They hold for the trials that did not
/// diverge: without a bound on its values, the mean of positive numbers has no upper bound [Bahadur and Savage 1956].
double lower_bound(const PositiveSample& sample, double level);
double upper_bound(const PositiveSample& sample, double level);

/// What can be said of a mean that should be 1.
struct MeanClaim {
    /// lower_bound to upper_bound, and upwards what the unseen share adds if each of its trials is of `unseen_size`.
    Interval bounds;
    bool above = false;  ///< above 1 + margin: a finding
    bool below = false;  ///< below 1 - margin: a finding
};

/// NEES/dimension of `degrees` of freedom in all its trials. Student's interval is too narrow for few trials, because
/// chi-square is skewed: the mean must also be beyond the exact bound for NEES distributed as (1 -+ margin) chi-square.
/// `unseen`: the level of the unseen share.
MeanClaim claim_on_nees(const PositiveSample& sample, double degrees, double level, double margin,
                        double unseen = levels::unseen);

/// The same for one number per trial of any distribution, from 200 trials on.
MeanClaim claim_on_mean(const PositiveSample& sample, double level, double margin, double unseen = levels::unseen);

/// Degrees of freedom of the NEES over all steps of N trials, from its spread, 2 N m^2/s^2: at least those of one step
/// and at most those of all, N d to N d K.
double degrees_over_steps(const PositiveSample& sample, int dimension, double steps);

/// 95 % interval of all means from that of `smallest` to that of `largest`: to be accepted, it lies within 1 -+ margin.
Interval acceptance_interval(const PositiveSample& smallest, const PositiveSample& largest);

/// The smallest margin within which an interval about 1 lies.
double margin_shown(const Interval& interval);

// Bias: the mean standardised error of a component, one number a trial, against a margin [docs/statistics.md, Verdict].

/// An error of at most this size in every trial and step is that of rounding numbers of size 16: 2^-48.
inline constexpr double rounding_error = 0x1p-48;

struct BiasClaim {
    double value = 0;            ///< mean error in sigmas
    Interval interval;           ///< corrected for the number of components, two-sided
    bool known_exactly = false;  ///< no bias; S and C of the component are no evidence and are to be left out
    bool finding = false;        ///< outside the margin
    bool accepted = false;       ///< inside the margin, at 95 %
    double shown = 0;            ///< the smallest margin inside which it is, at 95 %
};

/// `z`: moments over the trials of the component's mean standardised error; `largest_error`: |e| over all trials and
/// steps, in the component's unit; `components`: over which the level is shared; `margin` in sigmas.
BiasClaim claim_on_bias(const Moments& z, double largest_error, int components, double margin);

}  // namespace credence
