#pragma once
// Module verdict: the evidence that one arm's totals give on its filter: all numbers of docs/statistics.md but the
// verdict. Lists by step have K - 1 entries, for the steps 1 ... K - 1. NaN where there are too few trials.

#include <credence/detail/credibility.hpp>
#include <credence/detail/results.hpp>
#include <credence/statistics.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A ratio that is 1 for a consistent filter, step by step, beside the chi-square bounds that hold it 95 % of the time.
struct BandedRatio {
    std::vector<double> degrees;               ///< of freedom of the total, 0 where nothing was observed
    std::vector<double> ratio;                 ///< total / degrees
    std::vector<Interval> band;                ///< for each step by itself
    std::vector<Interval> simultaneous_band;   ///< for all steps together (Bonferroni)
    int observed = 0;                          ///< steps with degrees
    int outside = 0, outside_simultaneous = 0; ///< steps outside their bands
};

/// Share of trials whose NEES lies below a quantile of chi-square.
struct Coverage {
    double level = 0;
    std::vector<double> share;
    std::vector<Interval> interval;            ///< Wilson
    double over_steps = 0;                     ///< mean share over the steps: no interval, steps are not independent
};

/// Error against predicted standard deviation: root mean squares over trials, and over the components of the group.
struct Accuracy {
    std::vector<double> rmse, predicted;       ///< by step: sqrt(mean |e|^2), sqrt(mean trace P)
    std::vector<Moments> square, variance;     ///< by step: of |e|^2 and of trace P
    double over_steps = 0;                     ///< RMSE over all trials and steps
    double ratio = 0;                          ///< the same over its prediction; 1 for a consistent filter
    Interval ratio_ci95;                       ///< from the spread of |e|^2 alone
    std::string unit;                          ///< of the squares
};

/// One component group.
struct GroupEvidence {
    std::string name;
    int dimension = 0;
    std::vector<int> components;               ///< of the state
    Moments run;                               ///< of NEES/dim, averaged over each trial's steps
    Moments without_diverged{};                ///< what the verdict has for `run`, if it is shown of all finite trials
    std::vector<Moments> step;                 ///< of NEES/dim
    BandedRatio anees;
    std::vector<Coverage> coverage;
    std::vector<double> variance_ratio;        ///< var(NEES)/(2 dim); 1 for chi-square
    Accuracy accuracy;
    /// Bound on what rounding may have done to NEES, as a share of it [rounding_bound]; 0 where
    /// unknown.
    double rounding = 0;
    double largest = 0;  ///< of `run`'s numbers, of the detailed trials
    Moments centred;     ///< as `run`, with errors about their mean [Evidence::centred]
};

/// NEES of a component group with its error in another chart and the same covariance [docs/estimators.md, NEES]: shown
/// beside the group's own, without a verdict.
struct ChartEvidence {
    std::string chart, name;                   ///< invariant; all, pose
    int dimension = 0;
    Moments run;                               ///< of NEES/dim, averaged over each trial's steps
    std::vector<Moments> step;                 ///< of NEES/dim
    BandedRatio anees;
};

/// The innovations of a group of rows: all, features or edges.
struct NisEvidence {
    std::string part;
    BandedRatio nis;
    double degrees = 0, ratio = 0;             ///< over all steps
    Interval ratio95;                          ///< of the ratio, Student's, by the spread of trials; NaN for one trial
    Interval scale95;                          ///< of the factor by which S is too small, were the innovations white
    Moments run{};                             ///< the ratio, with the spread of `ratio95`
};

/// Correlation of whitened innovations a lag apart.
struct Whiteness {
    int lag = 0;
    std::int64_t count = 0;                    ///< products
    double correlation = 0;                    ///< their mean
    double scaled = 0;                         ///< the same over NIS/m, for where S has the wrong size
    double bound = 0, simultaneous_bound = 0;  ///< z/sqrt(count), for this lag and for all of them

    /// False where the S of some step is so ill-conditioned that its innovation has no whitened form.
    bool known() const;
};

/// Mean standardised error of one component.
struct BiasEvidence {
    std::string component, unit;
    Moments run;                               ///< averaged over each trial's steps
    std::vector<Moments> step;
    double largest_error = 0;                  ///< of the detailed trials, in the component's unit
    std::vector<double> mean_square;           ///< of their errors, by step, in the unit's square; NaN: unknown
    /// Of its squared standardised error, of the detailed trials, averaged over each one's steps: NEES of a group of
    /// its own. None where a group is this component alone. `centred`: with errors about their mean.
    Moments square{}, centred{};
    double largest_square = 0;  ///< of `square`'s numbers
    /// In sigmas, from the start to the end of the run in which it is largest; 0 where none is shown.
    double drift = 0, drift_half_width = 0;
    /// sqrt(R_jj/(P + R)_jj), R of the truth's own errors: the mean over the steps, and the largest; 0 without R.
    double truth = 0, largest_truth = 0;
};

/// The numbers of single trials from which directions are computed [src/statistics/moments/trial_moments.hpp].
struct TrialMoments;

/// Distance of the NEES of the whole state from chi-square(n), step by step.
struct DistributionEvidence {
    std::vector<double> distance, p;           ///< Kolmogorov-Smirnov
    bool exact = false;                        ///< else on equiprobable cells: low by at most 1/4096
};

/// On the detailed trials.
struct CredibilityEvidence {
    std::vector<Credibility> step;
    double nci = 0, inclination = 0;           ///< means over the steps
};

/// A trial with a large NEES of the whole state.
struct WorstTrial {
    std::int64_t trial = 0;
    double nees_ratio = 0;                     ///< NEES/dim, mean over its steps
    int step = 0;                              ///< at which its NEES is largest
};

/// Of the detailed trials, those with the largest NEES.
struct WorstTrials {
    std::vector<WorstTrial> trials;            ///< ten at most, the worst first
    double share = 0;                          ///< of the sum of NEES over the detailed trials
};

/// So many independent parts of runs are needed for a verdict; as many runs are trials by themselves, too.
inline constexpr int least_segments = 20;
/// Up to so many runs are counted by segments, and from so many on their spread tells what is drawn once in each.
inline constexpr int most_runs_in_segments = 200, runs_that_tell = 5;

/// Segments of the runs of a record [docs/statistics.md, One log]. If they count, they take the place of trials in
/// everything that is not by step.
struct SegmentEvidence {
    bool count = false;
    std::string differ{};                      ///< in which the runs differ, so that they count and segments do not
    int steps = 0;                             ///< of a segment; 0: there are none
    /// The longest of any run, in steps: infinite where its errors do not decorrelate, 0 where it was not computed.
    double autocorrelation_time = 0;
    std::string slowest;                       ///< the series that has it: `NEES/dim of all`, `error/sigma of x`
    std::size_t window = 0;                    ///< lags that are summed up in it; 0: no window is long enough
    std::vector<double> correlation;           ///< of that series by lag from 0 on, to twice the window
    std::int64_t steps_of_runs = 0;            ///< of all runs that did not fail
    std::vector<std::int64_t> run;             ///< [segments] that each is of

    /// Whether there are two for each run or more, so that they say more than the runs do.
    bool outnumber(std::int64_t runs) const { return !run.empty() && std::ssize(run) >= 2 * runs; }

    /// `55 independent runs`
    std::string worth() const {
        return std::to_string(run.size()) + (run.size() == 1 ? " independent run" : " independent runs");
    }
};

struct TruthEvidence;
/// Steps to which causes are applied [src/verdict/applied.hpp].
struct SampledSteps;

struct Evidence {
    std::int64_t trials = 0;                   ///< over which the evidence is computed
    std::int64_t all_trials = 0;
    std::int64_t left_out = 0;                 ///< trials that failed and are left out
    std::int64_t diverged = 0;                 ///< trials that diverged [columns.hpp], and left out, too
    bool diverged_are_judged = false;          ///< they are more than half, and not left out
    std::vector<WorstTrial> diverged_trials;   ///< of the detailed ones, ten at most, the worst first
    int steps = 0;
    std::vector<GroupEvidence> groups;         ///< the whole state first
    std::vector<ChartEvidence> charts;         ///< other charts of the error, where the study has them
    std::vector<NisEvidence> nis;              ///< all rows first; groups without rows are left out
    std::vector<Whiteness> whiteness;
    std::vector<BiasEvidence> bias;
    DistributionEvidence distribution;
    CredibilityEvidence credibility;
    WorstTrials worst;
    std::vector<Moments> quintiles;               ///< of NEES/n, of the trials by their log det P; may be empty
    std::shared_ptr<const TrialMoments> moments;  ///< of the detailed trials; null where the file has none
    /// The same with errors about the mean of their run, or of their segment where a drift is shown, where segments of
    /// fewer than `runs_that_tell` runs count; else null.
    std::shared_ptr<const TrialMoments> centred;
    bool of_innovations = false;                              ///< innovations stand for errors
    double epsilon = std::numeric_limits<double>::epsilon();  ///< relative spacing of the numbers of covariances
    SegmentEvidence segments;
    /// With the covariance R of the truth's own errors; null without it.
    std::shared_ptr<const TruthEvidence> truth;
    std::function<SampledSteps(const std::vector<int>& components)> sample{};  ///< Record::sample
    bool joint = true;                         ///< false: of a record without a covariance of the whole state
    /// Means and series of all finite trials, where diverged ones are left out; else null.
    std::shared_ptr<const Evidence> of_finite;

    std::int64_t failed_trials() const { return left_out + diverged; }
    /// Upper 95 % bound on the share of trials that fail or diverge [Clopper and Pearson 1934]; NaN of one log.
    double may_be_unseen() const;
    /// Whether segments count, of runs too few to be trials themselves.
    bool of_few_runs() const { return segments.count && trials < least_segments; }
    /// Whether the runs are too few to tell what was drawn once in each from a bias.
    bool has_offsets() const { return segments.count && trials < runs_that_tell; }
    /// Steps of what is independent: of a trial, or of a segment where these count.
    int steps_together() const { return segments.count ? segments.steps : steps; }
    /// What is independent: `trials` or `segments`.
    std::string units() const { return segments.count ? "segments" : "trials"; }
};

/// What the covariance R of the truth's own errors adds to the evidence by P alone [docs/statistics.md, Uncertain
/// truth].
struct TruthEvidence {
    Evidence added;                      ///< by P + R in place of P
    std::optional<Evidence> centred;     ///< the same of errors about their mean over the trials, step by step
    std::optional<Evidence> subtracted;  ///< by P - R, where the truth depends on the filter's own data
    std::vector<double> shares;          ///< [groups] mean tr((P + R)^-1 R)/d, NaN where unknown
};

/// Computes the evidence from an arm's totals. It selects series by their roles only.
Evidence evidence_of(const ScenarioResults& results, const ArmResults& arm);

/// The evidence of a record's runs with that of its segments, which come from results of their own, in everything that
/// is not by step, but for the bias of five runs or more; `runs.segments` says which they are. That of the runs alone
/// where these differ by more than their segments say.
/// `centred`: of the segments with errors about their mean.
Evidence by_segments(Evidence runs, Evidence segments, const std::optional<Evidence>& centred = {});

/// A component's mean error that changes over the runs, of segments; else 0.
struct Drift {
    double size = 0, half_width = 0;  ///< in sigmas, of the run in which it is largest
};
/// By component. `segments.segments` says of which runs they are.
std::vector<Drift> drifts_of(const Evidence& segments);

}  // namespace credence
