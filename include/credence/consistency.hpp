#pragma once
// Room 10: can the covariance be believed? The verdict of one arm [docs/statistics.md, Verdict].

#include <credence/results.hpp>
#include <credence/statistics.hpp>

#include <string>
#include <vector>

namespace credence {

/// consistent: equivalent to the nominal level within the margin, in every block; optimistic: P too small somewhere;
/// pessimistic: P too large somewhere; mixed: both; undecided: neither could be shown.
enum class Verdict { consistent, optimistic, pessimistic, mixed, undecided };

const std::string& verdict_name(Verdict verdict);

/// NEES / dimension of one block of the state, averaged over the steps; one number per trial.
struct BlockConsistency {
    std::string block;
    int dimension = 0;
    double ratio = 0, standard_error = 0;
    Interval ci95;
};

/// One thing that speaks against consistency: what (optimistic, pessimistic, biased), where (a block or component),
/// when.
struct Finding {
    std::string what, where, when;
    double value = 0;       ///< NEES / dimension, or mean standardised error, where it is farthest off
    Interval interval;      ///< corrected for all that was looked at
};

struct Consistency {
    Verdict verdict = Verdict::undecided;
    double margin = 0;
    std::vector<BlockConsistency> blocks;
    std::vector<Finding> findings;
    /// Undecided only: trials that would bring the intervals off the margin's edge; 0 where that is not known.
    double trials_to_decide = 0;
};

/// Judges one arm from its totals. `margin` delta: NEES / dimension within [1 - delta, 1 + delta] counts as consistent.
/// Intervals are Student's; those that speak against a block are Bonferroni-corrected over blocks and steps, those of
/// the bias over components and steps.
Consistency judge(const ScenarioResults& results, const ArmResults& arm, double margin);

/// The finding in words, such as `optimistic: pose, steps 4 to 19, NEES/dim 1.20 (1.16 to 1.24)`.
std::string sentence(const Finding& finding);

}  // namespace credence
