// `credence run --until`: grows a study and reports its precision and the trials that are still needed.

#include "base/formatted.hpp"
#include "cli/process/progress.hpp"
#include "cli/run/request.hpp"

#include <algorithm>
#include <cmath>

namespace credence::cli {

namespace {

const char* const unreachable = "no number of trials is expected to do";

/// A number with two significant digits.
std::string width_text(double width) { return !std::isfinite(width) ? "unknown" : formatted("%.2g", width); }

/// `0.1984 ± 0.0081`: as many decimals as show two digits of the half-width.
std::string interval_text(const GoalState& state) {
    if (!std::isfinite(state.half_width)) return "unknown (" + std::to_string(state.count) + " values)";
    const double size = state.half_width > 0 ? std::log10(state.half_width) : -3;
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(size)), 0, 12);
    return formatted("%.*f", decimals, state.mean) + " ± " + formatted("%.*f", decimals, state.half_width);
}

std::string prediction_text(const InterimAnalysis& analysis, const StoppingRule& rule) {
    const std::optional<std::int64_t> trials = predicted_trials(analysis, rule);
    if (!trials) return unreachable;
    return "about " + std::to_string(*trials) + " trials are needed" +
           (*trials > rule.ceiling ? ", more than the ceiling of " + std::to_string(rule.ceiling) : "");
}

std::string analysis_text(const InterimAnalysis& analysis, const StoppingRule& rule) {
    const GoalState& state = widest(analysis);
    return "interim analysis " + std::to_string(analysis.number) + ", " + std::to_string(analysis.trials) +
           " trials: " + state.name + " " + interval_text(state) + ", asked ± " + width_text(state.allowed) + "; " +
           (analysis.met ? "precise enough" : prediction_text(analysis, rule));
}

/// Progress over all interim analyses: trials that have been run, of those that the last analysis predicted.
class AnalysisProgress {
public:
    AnalysisProgress(bool quiet, const StoppingRule& rule) : quiet_(quiet), rule_(rule), line_(quiet) {}

    void operator()(const Progress& now) {
        now_ = now;
        line_({before_.done + now.done, before_.done + std::max(now.total, expected_), before_.seconds + now.seconds});
    }

    void analysis_done(const InterimAnalysis& analysis, std::size_t scenarios) {
        before_.done += now_.done;
        before_.seconds += now_.seconds;
        now_ = {};
        const std::int64_t most = std::min(predicted_trials(analysis, rule_).value_or(rule_.ceiling), rule_.ceiling);
        expected_ = (most - analysis.trials) * static_cast<std::int64_t>(scenarios);
        line_.finish();
        if (!quiet_) say(wrapped(analysis_text(analysis, rule_)) + "\n");
    }

private:
    bool quiet_;
    const StoppingRule& rule_;
    ProgressLine line_;
    Progress before_, now_;      ///< of earlier analyses, and of the current one
    std::int64_t expected_ = 0;  ///< trials still to run, as predicted by the last analysis
};

}  // namespace

InterimAnalysis grow_until_precise(Study& study, const RunRequest& request, RunOptions options) {
    const StoppingRule rule = request.rule();
    AnalysisProgress progress(request.quiet, rule);
    options.progress = [&](const Progress& now) { progress(now); };
    return run_until(study, rule, options, [&](const InterimAnalysis& analysis) {
        progress.analysis_done(analysis, study.scenarios.size());
    });
}

std::string stopping_text(const InterimAnalysis& analysis) {
    std::string text = "stopped at interim analysis " + std::to_string(analysis.number) + ", " +
                       std::to_string(analysis.trials) + " trials: " + (analysis.met ? "" : "not ") +
                       "as precise as asked. Intervals at " + formatted("%g", 100 * (1 - analysis.alpha)) +
                       " %, so that all analyses keep 95 %:\n";
    std::size_t width = 0;
    for (const GoalState& state : analysis.states) width = std::max(width, state.name.size());
    for (const GoalState& state : analysis.states)
        text += "  " + state.name + std::string(width - state.name.size() + 2, ' ') + interval_text(state) +
                ", asked ± " + width_text(state.allowed) + (state.met() ? "" : ": not met") + "\n";
    return text;
}

std::string imprecision_text(const InterimAnalysis& analysis, const StoppingRule& rule) {
    const GoalState& state = widest(analysis);
    const std::optional<std::int64_t> trials = predicted_trials(analysis, rule);
    const std::string needed = trials ? "it needs about " + std::to_string(*trials) + " trials" : unreachable;
    return "not as precise as asked at the ceiling of " + std::to_string(rule.ceiling) + " trials: " + state.name +
           " is " + interval_text(state) + ", asked ± " + width_text(state.allowed) + "; " + needed + ".";
}

}  // namespace credence::cli
