#pragma once
// Module verdict: whether the covariance can be believed: the verdict on one arm [docs/statistics.md, Verdict].

#include <credence/evidence.hpp>

#include <string>
#include <vector>

namespace credence {

/// consistent: equivalent to the nominal level within the margin, in every group; optimistic: P too small somewhere;
/// pessimistic: P too large somewhere; mixed: both; undecided: neither could be shown; failed: too many trials failed,
/// whatever the others show.
enum class Verdict { consistent, optimistic, pessimistic, mixed, undecided, failed };

const std::string& verdict_name(Verdict verdict);

/// The limits that a verdict uses, as shares: 0.05 is 5 %.
struct Limits {
    double margin = 0.05;  ///< NEES/dimension within [1 - margin, 1 + margin] counts as consistent
    double failed = 0.01;  ///< where a larger share of the trials failed, the verdict is `failed`

    Limits() = default;
    /// Implicit, because most callers only choose a margin.
    Limits(double nees_margin, double failed_share = 0.01) : margin(nees_margin), failed(failed_share) {}
};

/// Whether `failed` of `trials` is more than the share. Exactly the share is not more, whatever the rounding of share
/// times trials.
bool too_many_failed(std::int64_t failed, std::int64_t trials, double share);

/// One finding: what was found, where (a component group, a component, a group of rows), and when.
struct Finding {
    std::string what;       ///< optimistic, pessimistic, biased; as a caution: correlated, distribution_wrong
    std::string where, when;
    double value = 0;       ///< NEES/dimension, mean error/sigma, correlation, or distance, where it is farthest off
    Interval interval;      ///< corrected for all tests that were made
};

struct Consistency {
    Verdict verdict = Verdict::undecided;
    Limits limits;
    std::vector<Finding> findings;   ///< evidence against consistency
    /// Cautions that do not concern the size of P: innovations that are correlated, errors whose distribution is not
    /// normal. The verdict does not depend on them, except for that on a single trial.
    std::vector<Finding> cautions;
    /// Undecided only: number of trials at which the intervals no longer contain the margin's edge; 0 where it is not
    /// known.
    double trials_to_decide = 0;
};

/// Student's 95 % interval of NEES/dimension, averaged over the steps.
Interval over_steps95(const GroupEvidence& block);

/// The verdict on one arm. Intervals are Student's; those used against a group are Bonferroni-corrected over groups and
/// steps, those of the bias over components and steps. The verdict on a single trial uses its NIS and the whiteness of
/// its innovations alone. Where too many trials failed, findings are of the others, and the verdict is `failed`.
Consistency judge(const Evidence& evidence, const Limits& limits);

/// The finding in words, such as `optimistic: pose, steps 4 to 19, NEES/dim 1.20 (1.16 to 1.24)`.
std::string sentence(const Finding& finding);

}  // namespace credence
