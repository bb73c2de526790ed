#pragma once
// Sequential stopping: a study grows until the requested means have the requested precision. [docs/statistics.md,
// Stopping at a precision]
//
// Interim analyses are made at trial counts that are fixed in advance, N_j = 4096 * 2^(j-1), the last one at the
// ceiling. Analysis j spends alpha_j = 0.05 * 2^-j: its intervals are Student's at confidence 1 - alpha_j,
//   mean -+ h,  h = t_{1 - alpha_j/2, n - 1} sd / sqrt(n),  n the values of the first N_j trials that are not NaN.
// The study stops at the first analysis at which every h is small enough. Each of its intervals fails to cover with
// probability sum_j alpha_j <= 5 % at most (Bonferroni over the analyses), whatever made the study stop there; alpha
// spent at analyses fixed in advance: [Jennison and Turnbull 2000, ch. 7]. Each interval is so by itself: several
// together are not corrected for their number. Between analyses no data are examined.

#include <credence/statistics.hpp>
#include <credence/study.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace credence {

inline constexpr std::int64_t first_analysis_trials = 4096;
inline constexpr double all_looks_alpha = 0.05;  ///< spent by all interim analyses together, at most

/// The scale of a half-width: the column's own unit, or its |mean|.
enum class WidthKind { absolute, relative };

/// A requested precision: of a column's mean under every arm of every scenario, or of its mean difference between two
/// arms, by trial, in every scenario that has both.
struct StoppingGoal {
    std::string text;                  ///< as given, for messages
    std::string metric;                ///< name of a per-trial column
    std::string minuend, subtrahend;   ///< arms, or controllers where a scenario has one arm of them; empty: no pair
    WidthKind kind = WidthKind::absolute;
    double half_width = 0;             ///< at most this, times |mean| if it is relative

    bool is_pair() const { return !minuend.empty(); }
};

/// Goals, all of which must be met, and the trial counts of the interim analyses.
struct StoppingRule {
    std::vector<StoppingGoal> goals;
    std::int64_t ceiling = 10'000'000;             ///< number of trials at which the study ends in any case
    std::int64_t first_analysis = first_analysis_trials;
};

/// One requested mean at an interim analysis. NaN where there are too few values.
struct GoalState {
    std::string name;                  ///< such as `trace_P of kf-circle-constant/greedy.kf - fixed.kf`
    std::int64_t count = 0;            ///< n
    double mean = 0, standard_deviation = 0;
    double half_width = 0;             ///< h
    double allowed = 0;                ///< the requested h, in the column's unit

    bool met() const { return half_width <= allowed; }  // never with NaN
};

struct InterimAnalysis {
    std::int64_t trials = 0;
    int number = 0;                    ///< j, from 1
    double alpha = 0;                  ///< alpha_j
    std::vector<GoalState> states;     ///< at least one
    bool met = false;                  ///< whether every state is
    bool interrupted = false;          ///< the run was stopped before this analysis: there are no states
};

/// Reads `METRIC=HALFWIDTH` or `METRIC[ARM-ARM]=HALFWIDTH`, the half-width absolute (`0.01`) or relative (`0.5%`).
/// Throws InputError where the text is invalid; check_goals checks whether a study has the metric and the arms.
StoppingGoal parse_goal(const std::string& text);

/// Throws InputError, with a list of the valid names, where the study lacks a goal's metric, or no scenario has both of
/// its arms.
void check_goals(const std::vector<StoppingGoal>& goals, const Study& study);

/// alpha_j = 0.05 * 2^-j.
double analysis_alpha(int number);

/// first, 2 first, 4 first ... below the ceiling, and the ceiling itself. Both at least 1.
std::vector<std::int64_t> analysis_trials(std::int64_t ceiling, std::int64_t first = first_analysis_trials);

/// The interval of a sample's mean, one value a trial, at interim analysis `number`. Its name is not set.
GoalState decide(const Moments& moments, const StoppingGoal& goal, int number);

/// Interim analysis `number` at the first `trials` trials of every scenario; further trials are ignored, but where no
/// trial is kept there must not be any. Throws as check_goals does; throws std::logic_error if a scenario has fewer
/// trials, or more than can be ignored.
InterimAnalysis analysis_of(const Study& study, const std::vector<StoppingGoal>& goals, std::int64_t trials,
                            int number);

/// The trial count at which every unmet state is expected to be small enough: the next analysis, that at the ceiling or
/// one beyond it, at which t sd / sqrt(n) <= allowed if mean, sd and the share of NaN values stay the same; that of the
/// given analysis if it is met. Nothing if no 64-bit number of trials is expected to suffice.
std::optional<std::int64_t> predicted_trials(const InterimAnalysis& analysis, const StoppingRule& rule);

/// The state that is widest relative to its goal; states without an interval come first.
const GoalState& widest(const InterimAnalysis& analysis);

/// Calls `analysis` with the trials and the number of each interim analysis in turn, until one is met or the ceiling is
/// reached; returns the last one.
InterimAnalysis run_analyses(const StoppingRule& rule,
                             const std::function<InterimAnalysis(std::int64_t trials, int number)>& analysis);

/// Grows the study from analysis to analysis (run_study) until the goals are met or the ceiling is reached; returns the
/// last analysis. Trials that a study has beyond an analysis are neither used by it nor discarded: the analysis is the
/// same for any number of threads and any history. Where no trial is kept, a study cannot be analysed at fewer trials
/// than it has: such analyses are left out, their share of alpha unspent; the run that was interrupted has made them
/// already. Throws as check_goals does, before any trial. `options.trials` is not used; `after_analysis`, which may be
/// empty, receives every analysis.
InterimAnalysis run_until(Study& study, const StoppingRule& rule, RunOptions options,
               const std::function<void(const InterimAnalysis&)>& after_analysis = {});

/// A mean that a goal asks for: of a column of one arm, or of the differences between two.
struct StoppingSubject {
    const ScenarioResults* results;
    std::size_t column;
    const ArmResults* arm;
    const ArmResults* subtracted;  ///< null: not a difference
};

/// Throws as check_goals does; at least one.
std::vector<StoppingSubject> subjects_of(const StoppingGoal& goal, const Study& study);

}  // namespace credence
