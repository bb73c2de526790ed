#pragma once
// Module verdict: can the covariance be believed? The verdict of one arm [docs/statistics.md, Verdict].

#include <credence/evidence.hpp>

#include <string>
#include <vector>

namespace credence {

/// consistent: equivalent to the nominal level within the margin, in every block; optimistic: P too small somewhere;
/// pessimistic: P too large somewhere; mixed: both; undecided: neither could be shown; failed: too many trials failed,
/// whatever the others say.
enum class Verdict { consistent, optimistic, pessimistic, mixed, undecided, failed };

const std::string& verdict_name(Verdict verdict);

/// What a verdict is held against, as shares: 0.05 is 5 %.
struct Limits {
    double margin = 0.05;  ///< NEES/dimension within [1 - margin, 1 + margin] counts as consistent
    double failed = 0.01;  ///< where a larger share of the trials failed, the verdict is `failed`

    Limits() = default;
    /// Implicit, because most callers choose a margin and nothing else.
    Limits(double nees_margin, double failed_share = 0.01) : margin(nees_margin), failed(failed_share) {}
};

/// Whether `failed` of `trials` are more than the share. Exactly the share is not more, whatever the rounding of share
/// times trials.
bool too_many_failed(std::int64_t failed, std::int64_t trials, double share);

/// One thing that was found: what, where (a block, a component, a group of rows), when.
struct Finding {
    std::string what;       ///< optimistic, pessimistic, biased; as a caution: correlated, distribution_wrong
    std::string where, when;
    double value = 0;       ///< NEES/dimension, mean error/sigma, correlation, or distance, where it is farthest off
    Interval interval;      ///< corrected for all that was looked at
};

struct Consistency {
    Verdict verdict = Verdict::undecided;
    Limits limits;
    std::vector<Finding> findings;   ///< what speaks against consistency
    /// What does not bear on the size of P, and is worth knowing all the same: innovations that are correlated, errors
    /// whose distribution is not normal. The verdict does not depend on them, but for a single trial's.
    std::vector<Finding> cautions;
    /// Undecided only: trials that would bring the intervals off the margin's edge; 0 where that is not known.
    double trials_to_decide = 0;
};

/// Student's 95 % interval of NEES/dimension, averaged over the steps.
Interval over_steps95(const GroupEvidence& block);

/// Judges one arm. Intervals are Student's; those that speak against a block are Bonferroni-corrected over blocks and
/// steps, those of the bias over components and steps. A single trial is judged by its NIS and the whiteness of its
/// innovations alone. Where too many trials failed, findings are of the others, and the verdict is `failed`.
Consistency judge(const Evidence& evidence, const Limits& limits);

/// The finding in words, such as `optimistic: pose, steps 4 to 19, NEES/dim 1.20 (1.16 to 1.24)`.
std::string sentence(const Finding& finding);

}  // namespace credence
