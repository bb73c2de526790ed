#pragma once
// Texts that every format of a report uses.

#include <credence/report.hpp>

#include "base/wording.hpp"
#include "report/table.hpp"

#include <string>
#include <vector>

namespace credence {

/// A line of the reasons for an arm's verdict: a head, and the list after it.
struct Reason {
    std::string head;
    std::vector<std::string> parts;
    bool decides = false;  ///< the verdict rests on it: a finding, or failed trials
};

/// The reasons for an arm's verdict: the share of failed trials, the worst findings, notes, and the trials that would
/// decide. Empty for an arm that has not run yet.
std::vector<Reason> reasons_of(const ArmReport& arm);
std::string reason_text(const Reason& reason);

/// Why there is no verdict on an arm: it has not run yet, too many trials failed, or the reason why it is undecided.
/// Empty for a verdict.
std::string no_claim_text(const ArmReport& arm);

/// The verdict's name, or `not run yet`; and as a clause, such as `is consistent`.
std::string verdict_word(const ArmReport& arm);
std::string verdict_clause(const ArmReport& arm);

/// Whether the file has trials of a scenario.
bool has_run(const Report& report, const std::string& scenario);

/// `300 trials of each arm, root seed 1`; of the arms that have run.
std::string trials_text(const Report& report);

/// The note on what is missing where no trial is kept.
inline std::string no_trials_note() {
    return "only totals are kept: medians and distributions need the trials (" + program_name() +
           " run --keep trials).";
}

/// An arm's trials, and how many of them failed.
struct FailureCounts {
    std::int64_t trials = 0, left_out = 0, diverged = 0;
};
/// How failed trials are treated, such as `are left out of its numbers`, and diverged ones, such as `left out, too`.
struct FailureWords {
    std::string left_out, diverged;
};
/// A warning where more than `limit` of an arm's trials failed, and a note where some diverged.
std::vector<std::string> failure_lines(const std::string& arm, const FailureCounts& counts, double limit,
                                       const FailureWords& words);

/// The warnings before everything else: failed and diverged trials, troubles of a record, a study that is not complete
/// or keeps no trials.
std::vector<std::string> warnings_of(const Report& report);

/// An arm's verdict, and how many of its trials failed; `-` where it has not run yet.
Cell verdict_cell(const ArmReport& arm);
Cell failed_cell(const ArmReport& arm);
/// The upper bound on the share of trials that fail or diverge: `at most 1 %`; empty where there is none.
std::string unseen_text(const ArmReport& arm);

/// The column of that name; the first one where there is none.
const ColumnReport& column_named(const std::vector<ColumnReport>& columns, const std::string& name);

/// A column's name in words, with its unit.
std::string column_title(const std::string& column, const std::string& unit);

/// The component groups that get a line: those with several components, and the features (or other numbered groups)
/// that are farthest off.
std::vector<const GroupEvidence*> shown_groups(const Evidence& evidence);

/// Statistics of the values that are not NaN.
double mean_of(const std::vector<double>& values);

/// The step whose NEES is farthest from chi-square.
struct WorstDistribution {
    int step = 0, known = 0;     ///< known: steps with a distance
    double distance = 0, p = 0;  ///< p corrected for all of them
};
WorstDistribution worst_distribution(const DistributionEvidence& distribution);

/// Lags whose correlation is outside their joint bound.
int lags_outside(const std::vector<Whiteness>& whiteness);

/// `3 of 19`
std::string of_steps(int outside, int steps);

}  // namespace credence
