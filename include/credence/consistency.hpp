#pragma once
// Module verdict: whether the covariance can be believed: the verdict on one arm [docs/statistics.md, Verdict].

#include <credence/evidence.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// consistent: NEES, directions and bias are shown to lie within their margins; optimistic: something is too large for
/// P; pessimistic: something is too small for P; mixed: both; undecided: neither could be shown; failed: too many
/// trials failed, whatever the others show.
enum class Verdict { consistent, optimistic, pessimistic, mixed, undecided, failed };

const std::string& verdict_name(Verdict verdict);

/// The limits that a verdict uses, as shares: 0.05 is 5 %.
struct Limits {
    /// NEES/dimension within 1 -+ margin counts as consistent; a direction beyond it is a finding.
    double margin = 0.05;
    double failed = 0.01;     ///< where a larger share of the trials failed, the verdict is `failed`
    double direction = 0.10;  ///< the squared error of every direction, over what P says, within 1 -+ direction counts
    double bias = 0.1;        ///< a mean error within this many sigmas counts

    Limits() = default;
    /// Implicit, because most callers only choose a margin.
    Limits(double nees_margin, double failed_share = 0.01)
        : margin(nees_margin), failed(failed_share), direction(2 * nees_margin) {}
};

/// Whether `failed` of `trials` is more than the share. Exactly the share is not more, whatever the rounding of share
/// times trials.
bool too_many_failed(std::int64_t failed, std::int64_t trials, double share);

/// What a finding or a caution is about.
enum class Subject {
    size,       ///< NEES/dimension over all steps
    step,       ///< NEES/dimension at single steps
    direction,  ///< the squared error of a linear combination of components
    bias,
    innovations,  ///< NIS/m
    whiteness,
    distribution,  ///< of NEES, against chi-square
    window,        ///< mean errors over a tenth of the steps
    calibration,   ///< NEES/dimension of the trials with a small or a large P
    offset,        ///< a mean error, or its drift, of runs too few to tell what was drawn once from a bias
};

/// `size`, `step`, `direction` ...
const std::string& subject_name(Subject subject);

/// What is wrong: too large or too small for P, a mean error that is not 0; as a caution, innovations that are
/// correlated or a distribution that is not chi-square.
enum class Fault { optimistic, pessimistic, biased, correlated, non_chi_square };

/// `optimistic`, `pessimistic`, `biased`, `correlated`, `non-chi-square`
const std::string& fault_name(Fault fault);

/// One finding: what was found, where (a component group, a component, a group of rows), and when.
struct Finding {
    Subject about = Subject::size;
    Fault what = Fault::optimistic;
    std::string where;
    std::string when;       ///< such as `over all steps`; of a direction its name, such as `0.71 x - 0.71 y`
    double value = 0;       ///< NEES/dimension, mean error/sigma, correlation, or distance, where it is farthest off
    Interval interval;      ///< corrected for all tests that were made
    std::string measure;    ///< of `value`: NEES/dim, NIS/m, squared error over P's, mean error/sigma ...
};

/// A component's share in a direction, in units of its own sigma.
struct Loading {
    std::string component;
    double weight = 0;
};

/// A linear combination of the state, each component in units of its own sigma, and the ratio of its squared error to
/// what P says, over all steps.
struct DirectionOfGroup {
    std::string group;
    std::string name;                ///< such as `0.71 x - 0.71 y`
    double ratio = 0;
    Interval interval;               ///< corrected, each end one-sided
    double level = 0;                ///< of each end
    std::vector<Loading> loadings{}; ///< the vector has length 1; shares below a tenth of the largest are left out
};

/// What the trials say of all directions of the state.
struct DirectionsFound {
    std::string unknown;                       ///< why there are none; empty where there are
    double trials = 0;                         ///< from which they are computed
    std::vector<DirectionOfGroup> largest, smallest;  ///< by group of two or more components
    std::vector<double> spectrum;              ///< [n] ratios of the whole state's generalised eigenvectors, rising
    Interval range;                            ///< that contains the ratio of every direction, at 95 %
};

/// The number of trials at which an exactly consistent filter with the spread seen would be shown consistent in 80 % of
/// studies, as a range; 0 where it is not given.
struct TrialsNeeded {
    double low = 0, value = 0, high = 0;
};

/// Something that looks wrong and is not shown: its plain 90 % interval lies outside the margin, its corrected one does
/// not.
struct Suspicion {
    Subject about = Subject::size;
    Fault what = Fault::optimistic;    ///< or pessimistic or biased
    std::string where;                 ///< a component group or a component
    double value = 0;                  ///< its mean
    std::string measure;               ///< of `value`
    TrialsNeeded trials;               ///< that would show it, if mean and spread stay; over the mean's 90 % interval
};

/// The smallest margins for which the acceptance would hold: what the trials show, whatever was asked for. NaN where
/// nothing is shown.
struct Reached {
    double nees = 0;       ///< every NEES/dimension is within 1 -+ nees
    double direction = 0;  ///< the squared error of every direction, over what P says, is within 1 -+ direction
    double bias = 0;       ///< every mean error is within so many sigmas
};

/// What carries errors that are too large for P: their mean, their spread, or both.
enum class Carrier { mean, mean_beside_too_large_P, both, spread, unknown };

/// What an arm's errors are apart from their mean over the trials, step by step [docs/statistics.md, Attribution].
struct Attribution {
    Carrier carrier = Carrier::unknown;
    double share = 0;    ///< of the squared error, in units of P, that the mean carries
    double nees = 0;     ///< NEES/dimension of the whole state, apart from the mean
    Interval interval;   ///< Student's, 95 %
};

/// What can be said of the errors' size over P's where the truth has errors of its own, of covariance R.
struct TruthFactor {
    std::string group;
    double nees = 0;            ///< NEES/dimension by P + R, of errors about their mean
    Interval nees95, factor;    ///< its 95 % interval; in which the mean squared error over P's lies
    double deciding_sigma = 0;  ///< so many times the truth's sigma adds half of the margin to NEES/dimension
};

/// How far the truth would have to be off, sigma of each component, for an optimistic verdict on a log to be wrong.
struct TurningPoint {
    std::string where, unit;            ///< a component group or a component, whose components have this unit
    double vanishes = 0, right = 0;     ///< what is too large is no finding; NEES/dimension is 1
};

struct Consistency {
    Verdict verdict = Verdict::undecided;
    Limits limits;
    std::vector<Finding> findings;   ///< evidence against consistency
    /// What is no finding: offsets and drifts of few runs, and what does not concern the size of P, such as innovations
    /// that are correlated, or errors whose distribution is not normal. The verdict does not depend on them.
    std::vector<Finding> cautions;
    DirectionsFound directions;
    Reached reached;
    std::vector<std::string> hints;    ///< what such findings often come from
    bool withheld = false;             ///< P is larger than the errors of runs that are too few to find it so
    bool mix_up = false;               ///< a hint says that P or the errors were written wrongly
    bool chart_doubted = false;        ///< a hint says that the errors may be in another chart than P
    std::vector<std::string> reasons;  ///< undecided only: what could not be shown, and why
    std::optional<Attribution> attribution;  ///< of trials of a record, where something is too large
    /// undecided only: NEES/dimension of the whole state, below and above 1, that nine of ten such studies would find
    Interval smallest_faults{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    TrialsNeeded trials_needed;        ///< undecided only, and not where more trials cannot help
    std::vector<Suspicion> suspicions; ///< undecided only
    std::vector<TruthFactor> truth;    ///< by group; empty without R
    std::vector<TurningPoint> turning_points;  ///< by unit; empty with R

    /// Whether causes are looked for.
    bool looks_wrong() const { return withheld || !findings.empty(); }
};

/// Student's 95 % interval of NEES/dimension, averaged over the steps.
Interval over_steps95(const GroupEvidence& group);

/// The verdict on one arm [docs/statistics.md, Verdict]. The verdict on a single trial uses its NIS and the whiteness
/// of its innovations alone. Where too many trials failed, findings are of the others, and the verdict is `failed`.
Consistency judge(const Evidence& evidence, const Limits& limits);

/// What carries errors that were found too large: `about_means` is the evidence of errors about their mean at each
/// step, and `share` what that mean carries.
Attribution attribute(const Evidence& evidence, const Consistency& verdict, const Evidence& about_means, double share);

/// `mean`, `mean beside too large P`, `both`, `spread`, `unknown`
const std::string& carrier_name(Carrier carrier);

/// The attribution in words.
std::string sentence(const Attribution& attribution);

/// Replaces by NaN the NEES of the groups, and what rests on it, that rounding may have changed by more than a tenth of
/// the margin: `judge` says nothing by them.
void leave_out_rounded(Evidence& evidence, const Limits& limits);

/// Once all is said that the verdict's evidence says: makes groups, charts, innovations and biases those of all finite
/// trials, without what rounding may have changed.
void show_finite_trials(Evidence& evidence, const Limits& limits);

/// When a finding was made, or along what: `steps 4 to 19`, `direction 0.71 x - 0.71 y`.
std::string when_text(const Finding& finding);

/// The finding in words, such as `optimistic: pose, steps 4 to 19, NEES/dim 1.20 (1.16 to 1.24)`.
std::string sentence(const Finding& finding);

}  // namespace credence
