#pragma once
// Words that every rendering of a report shares.

#include <credence/report.hpp>

#include <string>
#include <vector>

namespace credence {

/// A line of why an arm has its verdict: a head, and what is listed behind it.
struct Reason {
    std::string head;
    std::vector<std::string> parts;
};

/// Why an arm has its verdict: how many trials failed, the worst of what was found, notes, and what would decide. Nothing
/// of an arm that is not run yet.
std::vector<Reason> reasons_of(const ArmReport& arm);
std::string reason_text(const Reason& reason);

/// Why nothing is claimed of an arm: that it is not run yet, that too many trials failed, or what leaves it undecided. Empty
/// where there is nothing to say.
std::string no_claim_text(const ArmReport& arm);

/// The verdict's name, or `not run yet`; and as a clause, such as `is consistent`.
std::string verdict_word(const ArmReport& arm);
std::string verdict_clause(const ArmReport& arm);

/// Whether the file has trials of a scenario.
bool has_run(const Report& report, const std::string& scenario);

/// `300 trials of each arm, root seed 1`; of the arms that have run.
std::string trials_text(const Report& report);

/// What is missing where no trial is kept.
inline const char* const no_trials_note =
    "only totals are kept: medians and distributions need the trials (credence run --keep trials).";

/// An arm's trials, and how many of them failed.
struct FailureCounts {
    std::int64_t trials = 0, left_out = 0, diverged = 0;
};
/// What becomes of the trials that failed, such as `are left out of its figures`, and of those that diverged.
struct FailureWords {
    std::string left_out, diverged;
};
/// A warning where more than `limit` of an arm's trials failed, and a note where some diverged.
std::vector<std::string> failure_lines(const std::string& arm, const FailureCounts& counts, double limit,
                                       const FailureWords& words);

/// What is said before anything else: failed and diverged trials, troubles of a record, a study that is not complete or
/// keeps no trials.
std::vector<std::string> warnings_of(const Report& report);

/// The figure of that name; the first one where there is none.
const ColumnReport& column_named(const std::vector<ColumnReport>& columns, const std::string& name);

/// A figure's name in words, with its unit.
std::string figure_title(const std::string& column, const std::string& unit);

/// The blocks worth a line: those of several parts, and the features (or whatever comes in numbers) that are farthest
/// off.
std::vector<const GroupEvidence*> shown_blocks(const Evidence& evidence);

/// Of the values that are known.
double mean_of(const std::vector<double>& values);

/// The step whose NEES is farthest from chi-square.
struct WorstDistribution {
    int step = 0, known = 0;     ///< known: steps with a distance
    double distance = 0, p = 0;  ///< p corrected for all of them
};
WorstDistribution worst_distribution(const DistributionEvidence& shape);

/// Lags whose correlation is outside their joint bound.
int lags_outside(const std::vector<Whiteness>& whiteness);

/// `3 of 19`
std::string of_steps(int outside, int steps);

}  // namespace credence
