// What a report says before everything else: its trials, those that failed, steps that are missing, what is not judged.

#include <algorithm>
#include <cmath>
#include <credence/text.hpp>
#include <iterator>

#include "report/format.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

/// The trials of a record that are left out of the numbers, the first of them by name.
void add_troubles(const Report& report, std::vector<std::string>& lines) {
    constexpr std::size_t most = 5;
    const std::size_t shown = std::min(most, report.troubles.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const RecordTrouble& trouble = report.troubles[i];
        const std::string trial = std::to_string(trouble.trial);
        lines.push_back("trial " + trial + ", step " + std::to_string(trouble.step + 1) + " ([" + trial + ", " +
                        std::to_string(trouble.step) + "] in the file): " + trouble.what +
                        (failed(trouble.status) ? "; the trial is left out of the numbers."
                         : report.arms.front().evidence.diverged_are_judged
                             ? "."
                             : "; the trial is left out of the verdict."));
    }
    std::int64_t failed = 0;
    for (const ArmReport& arm : report.arms) failed += arm.failed_trials();
    if (shown > 0 && failed > static_cast<std::int64_t>(shown))
        lines.push_back("... and " + std::to_string(failed - static_cast<std::int64_t>(shown)) + " more trials.");
}

/// The failed and diverged trials at the points of sweeps, whose tables count them, in one line.
void add_swept_failures(const Report& report, const std::set<std::string>& swept, std::vector<std::string>& lines) {
    const auto share = [](const ArmReport& arm) {
        return static_cast<double>(arm.failed_trials()) / static_cast<double>(arm.trials);
    };
    const ArmReport* worst = nullptr;
    for (const ArmReport& arm : report.arms)
        if (swept.contains(arm.scenario) && arm.failed_trials() > 0 && (!worst || share(arm) > share(*worst)))
            worst = &arm;
    if (worst == nullptr) return;
    const bool many = too_many_failed(worst->failed_trials(), worst->trials, report.limits.failed);
    lines.push_back((many ? "WARNING: trials failed or diverged at points of a sweep, most, "
                          : "note: trials failed or diverged at points of a sweep, most, ") +
                    std::to_string(worst->failed_trials()) + " of " + std::to_string(worst->trials) + ", of " +
                    worst->scenario + "/" + worst->arm +
                    ". The tables by point count them; failed ones are left out of the numbers, diverged ones of the "
                    "verdict.");
}

/// What becomes of diverged trials, and which they are.
std::string diverged_text(const Evidence& evidence) {
    if (evidence.diverged_are_judged) return "judged all the same, because they are more than half";
    std::vector<std::string> trials;
    for (const WorstTrial& one : evidence.diverged_trials)
        trials.push_back(std::to_string(one.trial) + " (most at step " + std::to_string(one.step) + ")");
    const Moments none, &without = evidence.groups.empty() ? none : evidence.groups.front().without_diverged;
    return "left out of the verdict" +
           (without.count > 0 ? ", which has NEES/dim " + with_interval(without.mean, t_interval(without)) : "") +
           ", kept in means and series" +
           (trials.empty() ? "" : "; trial" + std::string(trials.size() == 1 ? " " : "s ") + joined(trials));
}

/// Whether a count is far above the mean of all: by twice, and by more than chance makes it.
bool stands_out(std::int64_t count, double mean) {
    return static_cast<double>(count) > std::max(2 * mean, mean + 6 * std::sqrt(mean) + 1);
}

/// The share of the steps that are missing in a record, and where most of them are.
std::string gaps_text(const ArmReport& arm) {
    const RecordGaps& gaps = arm.gaps;
    if (gaps.missing == 0) return {};
    const auto missing = static_cast<double>(gaps.missing);
    std::string text = "note: " + percent(missing / static_cast<double>(gaps.steps)) + " of the steps of " +
                       arm.scenario + "/" + arm.arm + " are missing (" + std::to_string(gaps.missing) + " of " +
                       std::to_string(gaps.steps) + ", in " + std::to_string(gaps.runs) + " of " +
                       std::to_string(arm.evidence.trials) + " trials): error and covariance are NaN there.";
    if (stands_out(gaps.of_trial, missing / static_cast<double>(arm.evidence.trials)))
        text += " Trial " + std::to_string(gaps.trial) + " lacks most, " + std::to_string(gaps.of_trial) + ".";
    std::vector<int> steps;
    for (std::size_t k = 0; k < gaps.by_step.size(); ++k)
        if (stands_out(gaps.by_step[k], missing / static_cast<double>(gaps.by_step.size())))
            steps.push_back(static_cast<int>(k) + 1);
    if (!steps.empty())
        text += " Most often missing: " + steps_text(steps) + ", in up to " +
                std::to_string(std::ranges::max(gaps.by_step)) + " trials.";
    return text;
}

/// Whether its runs are counted by their segments, or would be if there were more of these.
bool is_of_logs(const ArmReport& arm) {
    const SegmentEvidence& segments = arm.evidence.segments;
    return segments.count || (segments.steps_of_runs > 0 && (arm.trials == 1 || segments.outnumber(arm.trials)));
}

/// `one log of 3000 steps, worth about 55 independent runs (segments of 54 steps)`
std::string log_text(const ArmReport& arm) {
    const SegmentEvidence& segments = arm.evidence.segments;
    const std::string runs = arm.trials == 1 ? "one log of " : std::to_string(arm.trials) + " runs of together ",
                      text = runs + std::to_string(segments.steps_of_runs) + " steps";
    if (segments.steps == 0) return text;
    return text + ", worth about " + segments.worth() + " (segments of " + std::to_string(segments.steps) + " steps)";
}

}  // namespace

std::string trials_text(const Report& report) {
    if (report.arms.size() == 1)
        if (const ArmReport& arm = report.arms.front(); is_of_logs(arm)) return log_text(arm);
    std::int64_t least = 0, most = 0;
    std::size_t run = 0;
    for (const ArmReport& arm : report.arms) {
        if (arm.not_run()) continue;
        least = run == 0 ? arm.trials : std::min(least, arm.trials);
        most = std::max(most, arm.trials);
        ++run;
    }
    const std::string text = (least == most ? "" : std::to_string(least) + " to ") + std::to_string(most) +
                             (most == 1 ? " trial" : " trials");
    if (!report.root_seed) return text;
    return text + " of each arm" + (run == 0 || run == report.arms.size() ? "" : " run so far") + ", root seed " +
           std::to_string(*report.root_seed);
}

std::vector<std::string> failure_lines(const std::string& arm, const FailureCounts& counts, double limit,
                                       const FailureWords& words) {
    std::vector<std::string> lines;
    const std::int64_t failed = counts.left_out + counts.diverged;
    const std::string of = " trials of " + arm;
    if (too_many_failed(failed, counts.trials, limit))
        lines.push_back("WARNING: " + std::to_string(failed) + " of " + std::to_string(counts.trials) + of +
                        (counts.diverged == 0   ? " failed and " + words.left_out
                         : counts.left_out == 0 ? " diverged"
                                                : " failed or diverged; " + std::to_string(counts.left_out) +
                                                      " of them " + words.left_out) +
                        ".");
    if (counts.diverged > 0)
        lines.push_back("note: " + std::to_string(counts.diverged) + (counts.diverged == 1 ? " trial of " + arm : of) +
                        " diverged (NEES/dim over the run beyond " + short_number(diverged_nees_ratio) +
                        "): " + words.diverged + ".");
    return lines;
}

std::vector<std::string> warnings_of(const Report& report) {
    std::vector<std::string> lines;
    const std::set<std::string> swept = swept_scenarios(report);
    add_swept_failures(report, swept, lines);
    for (const ArmReport& arm : report.arms) {
        if (swept.contains(arm.scenario)) continue;
        const FailureCounts counts{arm.trials, arm.failed, arm.diverged};
        std::ranges::copy(failure_lines(arm.scenario + "/" + arm.arm, counts, report.limits.failed,
                                        {"are left out of its numbers", diverged_text(arm.evidence)}),
                          std::back_inserter(lines));
    }
    for (const ArmReport& arm : report.arms)
        if (const std::string text = gaps_text(arm); !text.empty()) lines.push_back(text);
    add_troubles(report, lines);
    for (const std::string& sentence : report.not_judged) lines.push_back("note: " + sentence);
    if (!report.complete) {
        const auto not_run = std::ranges::count_if(report.arms, &ArmReport::not_run);
        lines.push_back("note: the study is not complete: it was asked for " + std::to_string(report.trials) +
                        " trials of each arm" +
                        (not_run == 0 ? "."
                                      : ", and " + std::to_string(not_run) + " of " +
                                            std::to_string(report.arms.size()) + " arms are not run yet."));
    }
    if (report.keep == Keep::aggregates) lines.push_back("note: " + no_trials_note());
    return lines;
}

}  // namespace credence
