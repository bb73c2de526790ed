#pragma once
// Room 10: can the covariance be believed? The verdict of one arm [docs/statistics.md, Verdict].

#include <credence/evidence.hpp>

#include <string>
#include <vector>

namespace credence {

/// consistent: equivalent to the nominal level within the margin, in every block; optimistic: P too small somewhere;
/// pessimistic: P too large somewhere; mixed: both; undecided: neither could be shown.
enum class Verdict { consistent, optimistic, pessimistic, mixed, undecided };

const std::string& verdict_name(Verdict verdict);

/// One thing that was found: what, where (a block, a component, a group of rows), when.
struct Finding {
    std::string what;       ///< optimistic, pessimistic, biased; as a caution: correlated, misshapen
    std::string where, when;
    double value = 0;       ///< NEES/dimension, mean error/sigma, correlation, or distance, where it is farthest off
    Interval interval;      ///< corrected for all that was looked at
};

struct Consistency {
    Verdict verdict = Verdict::undecided;
    double margin = 0;
    std::vector<Finding> findings;   ///< what speaks against consistency
    /// What does not bear on the size of P, and is worth knowing all the same: innovations that are correlated, errors
    /// whose distribution is not normal. The verdict does not depend on them, but for a single trial's.
    std::vector<Finding> cautions;
    /// Undecided only: trials that would bring the intervals off the margin's edge; 0 where that is not known.
    double trials_to_decide = 0;
};

/// Student's 95 % interval of NEES/dimension, averaged over the steps.
Interval over_steps95(const BlockEvidence& block);

/// Judges one arm. `margin` delta: NEES/dimension within [1 - delta, 1 + delta] counts as consistent. Intervals are
/// Student's; those that speak against a block are Bonferroni-corrected over blocks and steps, those of the bias over
/// components and steps. A single trial is judged by its NIS and the whiteness of its innovations alone.
Consistency judge(const Evidence& evidence, double margin);

/// The finding in words, such as `optimistic: pose, steps 4 to 19, NEES/dim 1.20 (1.16 to 1.24)`.
std::string sentence(const Finding& finding);

}  // namespace credence
