#include "study/stopping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace credence {

namespace {

/// Of the first `trials` trials: from the totals if the study has no more, else from their values.
Moments moments_of(const StoppingSubject& subject, std::int64_t trials) {
    const ScenarioResults& results = *subject.results;
    if (results.trials == trials)
        return subject.subtracted == nullptr
                   ? column_moments(*subject.arm, subject.column)
                   : credence::moments_of(
                         column_differences(results, *subject.arm, *subject.subtracted, subject.column).difference);
    const auto first_values = [&](const ArmResults& arm) {
        std::vector<double> values = figure_values(results, arm, subject.column);
        values.resize(static_cast<std::size_t>(trials));
        return values;
    };
    const std::vector<double> values = first_values(*subject.arm);
    return credence::moments_of(subject.subtracted == nullptr
                                    ? exact_moments(values)
                                    : differences_of(values, first_values(*subject.subtracted)).difference);
}

std::string name_of(const StoppingSubject& subject) {
    const std::string pair = subject.subtracted == nullptr ? "" : " - " + subject.subtracted->name;
    return subject.results->columns[subject.column].name + " of " + subject.results->scenario.name + "/" +
           subject.arm->name + pair;
}

/// t_{1 - alpha_j/2, n - 1} sd / sqrt(n)
double half_width_of(double standard_deviation, double count, int number) {
    return t_quantile(analysis_alpha(number), count - 1) * standard_deviation / std::sqrt(count);
}

/// How wide a state is relative to its goal: 0 for one that does not vary, infinite for one without an interval.
double excess(const GoalState& state) {
    const double ratio = state.half_width / state.allowed;
    if (!std::isnan(ratio)) return ratio;
    return state.met() ? 0 : std::numeric_limits<double>::infinity();
}

/// predicted_trials of one state that is not met.
std::optional<std::int64_t> predicted_for(const GoalState& state, const InterimAnalysis& analysis,
                                          const StoppingRule& rule) {
    const double share = static_cast<double>(state.count) / static_cast<double>(analysis.trials);
    const auto enough = [&](std::int64_t trials, int number) {
        return half_width_of(state.standard_deviation, share * static_cast<double>(trials), number) <= state.allowed;
    };
    const auto at_the_ceiling = static_cast<int>(analysis_trials(rule.ceiling, rule.first_analysis).size());
    std::int64_t trials = rule.first_analysis;
    for (int number = 1;; ++number) {
        if (number == at_the_ceiling && enough(rule.ceiling, number)) return rule.ceiling;
        if (trials > analysis.trials && enough(trials, number)) return trials;
        if (trials > std::numeric_limits<std::int64_t>::max() / 2) return std::nullopt;
        trials *= 2;
    }
}

/// An interrupted run decides nothing, and makes no further interim analysis.
InterimAnalysis interrupted_look(std::int64_t trials, int number) {
    InterimAnalysis analysis{trials, number, analysis_alpha(number), {}, false};
    analysis.interrupted = true;
    return analysis;
}

}  // namespace

double analysis_alpha(int number) { return std::ldexp(all_looks_alpha, -number); }

std::vector<std::int64_t> analysis_trials(std::int64_t ceiling, std::int64_t first) {
    std::vector<std::int64_t> analyses;
    for (std::int64_t trials = first; trials < ceiling; trials = trials > ceiling / 2 ? ceiling : 2 * trials)
        analyses.push_back(trials);
    analyses.push_back(ceiling);
    return analyses;
}

GoalState decide(const Moments& moments, const StoppingGoal& goal, int number) {
    GoalState state;
    state.count = static_cast<std::int64_t>(moments.count);
    state.mean = moments.mean;
    state.standard_deviation = moments.standard_deviation;
    state.half_width = half_width_of(state.standard_deviation, moments.count, number);
    state.allowed = goal.half_width * (goal.kind == WidthKind::relative ? std::abs(state.mean) : 1);
    return state;
}

InterimAnalysis analysis_of(const Study& study, const std::vector<StoppingGoal>& goals, std::int64_t trials,
                            int number) {
    for (const ScenarioResults& results : study.scenarios)
        if (results.trials < trials || (results.keep == Keep::aggregates && results.trials > trials))
            throw std::logic_error("an interim analysis of trials that are not there");
    InterimAnalysis analysis{trials, number, analysis_alpha(number), {}, true};
    for (const StoppingGoal& goal : goals)
        for (const StoppingSubject& subject : subjects_of(goal, study)) {
            analysis.states.push_back(decide(moments_of(subject, trials), goal, number));
            analysis.states.back().name = name_of(subject);
            analysis.met = analysis.met && analysis.states.back().met();
        }
    return analysis;
}

std::optional<std::int64_t> predicted_trials(const InterimAnalysis& analysis, const StoppingRule& rule) {
    std::int64_t most = analysis.trials;
    for (const GoalState& state : analysis.states) {
        if (state.met()) continue;
        const std::optional<std::int64_t> trials = predicted_for(state, analysis, rule);
        if (!trials) return std::nullopt;
        most = std::max(most, *trials);
    }
    return most;
}

const GoalState& widest(const InterimAnalysis& analysis) {
    return *std::ranges::max_element(analysis.states, {}, excess);
}

InterimAnalysis run_analyses(const StoppingRule& rule,
                             const std::function<InterimAnalysis(std::int64_t trials, int number)>& analysis) {
    InterimAnalysis last;
    for (const std::int64_t trials : analysis_trials(rule.ceiling, rule.first_analysis)) {
        last = analysis(trials, last.number + 1);
        if (last.met || last.interrupted) break;
    }
    return last;
}

InterimAnalysis run_until(Study& study, const StoppingRule& rule, RunOptions options,
               const std::function<void(const InterimAnalysis&)>& after_analysis) {
    check_goals(rule.goals, study);
    return run_analyses(rule, [&](std::int64_t trials, int number) {
        // All scenarios of a study get the same number of trials: if a scenario has more, that of the one that has
        // most.
        options.trials = std::max(trials, least_trials(study));
        const bool aggregates = keep_of(study) == Keep::aggregates;
        if (aggregates && options.trials > trials && trials < rule.ceiling)
            return InterimAnalysis{trials, number, analysis_alpha(number), {}, false};
        run_study(study, options);
        if (!study.complete) return interrupted_look(trials, number);
        InterimAnalysis analysis = analysis_of(study, rule.goals, aggregates ? options.trials : trials, number);
        if (after_analysis) after_analysis(analysis);
        return analysis;
    });
}

}  // namespace credence
