#pragma once
// The verdict while its parts are judged: findings against consistency, and what was or was not shown for it.

#include <credence/consistency.hpp>

#include "statistics/mean_bounds.hpp"
#include "statistics/moments/directions.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace credence {

enum class Side { inside, above, below };

/// An estimate with the half-width of its interval.
struct Estimate {
    double value = 0, half_width = 0;
    Interval interval() const { return {value - half_width, value + half_width}; }
};

inline Side side_of(const Interval& interval, double margin) {
    if (interval.low > 1 + margin) return Side::above;
    if (interval.high < 1 - margin) return Side::below;
    return Side::inside;
}

inline bool within(const Interval& interval, double margin) {
    return interval.low >= 1 - margin && interval.high <= 1 + margin;
}

inline Fault fault_of(Side side) { return side == Side::above ? Fault::optimistic : Fault::pessimistic; }

/// `a, b, c and 2 more`, of one name or more.
std::string first_of(const std::vector<std::string>& names);

/// `steps 3 to 7, 9`, from numbers in order.
std::string listed(const std::string& what, const std::vector<int>& numbers);
inline std::string steps_text(const std::vector<int>& steps) { return listed("step", steps); }

/// Steps with a finding, and the one of them that is farthest off.
struct Found {
    std::vector<int> steps;
    double value = 0;
    Interval interval;

    void add(std::size_t k, double mean, const Interval& bounds) {
        if (steps.empty() || std::abs(mean - 1) > std::abs(value - 1)) {
            value = mean;
            interval = bounds;
        }
        steps.push_back(static_cast<int>(k) + 1);
    }
};

/// The verdict on one run whose segments do not count: what no correlation of its steps can explain.
Consistency judge_single_run(const Evidence& evidence, const Limits& limits);

/// Adds the cautions to a verdict.
void caution_about_whiteness(const Evidence& evidence, Consistency& verdict);
void caution_about_innovations(const Evidence& evidence, Consistency& verdict);
void caution_about_distribution(const Evidence& evidence, Consistency& verdict);

/// Sentences on what findings such as these often come from. Says in the verdict whether that is a mix-up.
std::vector<std::string> causes_of(const Evidence& evidence, Consistency& verdict);

/// Whether innovations are as large as S says, and not correlated; false without them.
bool innovations_are_right(const Evidence& evidence, const Limits& limits);

/// A sentence on NEES that grows beyond that of a diverged trial, which it does not where a factor on P or a unit is
/// wrong from the start; empty where it does not.
std::string divergence_of(const Evidence& evidence);

/// Sentences that are empty where there is nothing to say. On variances that stand for "unknown".
std::string placeholders_of(const Evidence& evidence);
/// On mean errors that are the same at all steps, as far as these can tell.
std::string offset_of(const Evidence& evidence);
/// On what was written wrongly: of a record by its steps, and else by one step of each mean size.
std::string mix_up_of(const Evidence& evidence);
/// On two components that are right by themselves, and whose errors are correlated where P never says so.
std::string dropped_of(const Evidence& evidence);
/// On two detailed trials that are the same.
std::string repeated_trials(const Evidence& evidence);

/// Adds hints: what findings such as these often come from.
void add_hints(const Evidence& evidence, Consistency& verdict);

/// The margins of a part of the trials or steps, over those of all.
inline constexpr double margins_of_part = 3;

class Judgement {
public:
    explicit Judgement(const Limits& limits) : limits_(limits) {}
    const Limits& limits() const { return limits_; }
    bool has_findings() const { return !findings_.empty(); }

    /// A finding that something is too large (above) or too small for P; its `what` is set here.
    void add(Side side, Finding finding);
    void add_bias(Finding finding);
    /// Innovations that are correlated, where the verdict is of them: their sums are too large for S, or too small.
    void add_correlation(Finding finding);
    /// What is said and is no finding.
    void note(Finding finding);
    /// Whether something was shown to lie within its margin; `what` names it.
    void accept(bool shown, const std::string& what);
    /// What was shown in one group, component or all directions; infinite where nothing was.
    void reach(double Reached::* margin, double value);
    /// `consistent` is withheld, for this reason, which more trials may remove or not.
    void not_shown(const std::string& why, bool more_trials_help);
    void suspect(Suspicion suspicion);
    /// That P is larger than the errors of runs that are too few to find it so.
    void withhold(const std::string& what) {
        withheld_ = true;
        not_shown(what, true);
    }

    DirectionsFound directions;

    /// The verdict, after all parts.
    Consistency consistency(const Evidence& evidence);

private:
    Limits limits_;
    std::vector<Finding> findings_, notes_;
    std::vector<std::string> reasons_, unknown_;
    std::vector<Suspicion> suspicions_;
    Reached reached_;
    bool above_ = false, below_ = false, all_shown_ = true, more_trials_help_ = true, withheld_ = false;
};

/// Whether rounding may change a group's NEES by more than a share of the margin: then nothing is said by it.
bool is_rounded(const GroupEvidence& group, const Limits& limits);

/// A number of trials to two digits.
double to_two_digits(double trials);

/// A mean that looks wrong at 90 % and is not shown to be: how many trials would show it at `level`, one-sided. Nothing
/// where it does not look wrong.
std::optional<Suspicion> suspicion_of(const PositiveSample& sample, double level, double margin);
std::optional<Suspicion> suspicion_of_bias(const Moments& z, double level, double margin);

/// Those of these components that some trial has and that are not known exactly: the others have no error to be too
/// large or too small.
std::vector<int> uncertain_components(const Evidence& evidence, const std::vector<int>& components);

/// From so many trials on, the mean of numbers of an unknown distribution is known well enough.
inline constexpr double many_trials = 200;

/// How many groups are judged: those that are named, and the components that are none of them.
int groups_judged(const Evidence& evidence);

/// A group's NEES/dimension, one number a trial.
struct JudgedSize {
    std::string name;
    int dimension = 0;
    std::vector<int> components;
    PositiveSample sample, centred;  ///< `centred`: of errors about their mean; no trials where these are not judged
};
/// What can be said of it over all steps, each at a one-sided level.
MeanClaim claim_on_size(PositiveSample sample, int dimension, double level, const Evidence& evidence, double margin);

/// The smallest faults of the whole state's size that such evidence shows in 90 % of studies: NEES/dimension that is
/// too small, and too large. NaN where there is none up to a factor of 100.
Interval smallest_faults(const Evidence& evidence, const Limits& limits);

/// Finds it too large or too small. `place`: of the group among all that are judged.
void judge_size(const JudgedSize& size, int place, const Evidence& evidence, Judgement& judgement);

/// NEES of every component by itself.
void judge_components(const Evidence& evidence, Judgement& judgement);

/// Whether a component has an offset or a drift in its runs [judge_bias].
bool has_offset(const BiasEvidence& bias, const Evidence& evidence, const Limits& limits);

/// Bounds on the mean over the steps of NEES/dimension, for a filter that is right, whatever the correlation of the
/// steps of each of so many independent runs: P(mean >= c) <= exp(-runs d/2 (c - 1 - ln c)), likewise below [Chernoff
/// 1952; Jensen's inequality for the mean].
Interval bounds_at_any_correlation(double runs, int dimension, double level);

/// Withholds that something is too small, which runs that are so few cannot show, and says it of these runs.
void withhold_too_small(const JudgedSize& size, const Interval& bounds, const Evidence& evidence, Judgement& judgement);

/// Correlations of innovations that differ from 0 by significantly more than the margin, the largest of them.
std::optional<Finding> correlation_found(const Evidence& evidence, double margin);

/// Correlated innovations, where the verdict is of innovations.
void judge_innovations(const Evidence& evidence, Judgement& judgement);

/// Directions of every group of two or more components.
void judge_directions(const Evidence& evidence, Judgement& judgement);

/// Mean errors against the margin of the bias, in sigmas.
void judge_bias(const Evidence& evidence, Judgement& judgement);

/// Every window of the steps, from 50 on: withholds `consistent` where NEES/dimension or a mean error is beyond three
/// times its margin, and finds the latter where it is shown.
void judge_windows(const Evidence& evidence, Judgement& judgement);

/// NEES/dimension of the whole state in every quintile of the trials by their P, against three times its margin.
void judge_quintiles(const Evidence& evidence, Judgement& judgement);

/// Withholds `consistent` where segments of runs depend on each other, or runs differ.
void judge_segments(const Evidence& evidence, Judgement& judgement);

/// Few runs whose segments are too few to count: finds what is wrong whatever the spread of their NEES.
void judge_few_runs(const Evidence& evidence, Judgement& judgement);

/// The verdict on the trials that did not fail, by P alone.
Consistency judge_survivors(const Evidence& evidence, const Limits& limits);
/// The same with the covariance of the truth's own errors, `evidence.truth`.
Consistency judge_with_truth(const Evidence& evidence, const Limits& limits);

/// How far a truth that is off by a draw of its own, once, may move a mean error, in sigmas of P + R; 0 without R.
double truth_allowance(double share, const Evidence& evidence);

/// How many trials would do [docs/theory/statistics.md, Advice], to two digits; 0 below 30 trials.
TrialsNeeded trials_needed(const Evidence& evidence, const Limits& limits);

}  // namespace credence
