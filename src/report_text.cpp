// The report for people: verdicts first, then why, then where (report_text_detail.cpp).

#include <credence/report.hpp>
#include <credence/text.hpp>

#include "report_format.hpp"
#include "report_text_detail.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// How far a finding is from what a consistent filter gives.
double distance_off(const Finding& finding) {
    return finding.what == "biased" ? std::abs(finding.value) : std::abs(std::log(finding.value));
}

/// The findings of one kind: each block or component at its worst, the farthest off first.
std::vector<std::string> findings_parts(const std::vector<Finding>& findings, const std::string& what) {
    constexpr std::size_t most = 3;
    std::vector<Finding> worst;
    for (const Finding& finding : findings) {
        if (finding.what != what) continue;
        const auto same =
            std::find_if(worst.begin(), worst.end(), [&](const Finding& f) { return f.where == finding.where; });
        if (same == worst.end()) worst.push_back(finding);
        else if (distance_off(finding) > distance_off(*same)) *same = finding;
    }
    std::sort(worst.begin(), worst.end(),
              [](const Finding& f, const Finding& g) { return distance_off(f) > distance_off(g); });
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < std::min(most, worst.size()); ++i)
        parts.push_back(worst[i].where + " " + number(worst[i].value, 2) + " (" + worst[i].when + ")");
    if (worst.size() > most) parts.push_back(std::to_string(worst.size() - most) + " more");
    return parts;
}

/// Why an arm has its verdict; JSON has every finding with its interval.
std::string why(const ArmReport& arm) {
    constexpr std::size_t indent = 6;
    const Consistency& verdict = arm.consistency;
    std::string text;
    const auto add = [&](const std::string& line) { text += std::string(indent, ' ') + line + "\n"; };
    const auto list = [&](const std::string& what, const std::string& measure) {
        if (const auto parts = findings_parts(verdict.findings, what); !parts.empty())
            add(wrapped_list(what + " (" + measure + "):", parts, indent));
    };
    list("optimistic", arm.evidence.trials == 1 ? "NIS/m" : "NEES/dim");
    list("pessimistic", arm.evidence.trials == 1 ? "NIS/m" : "NEES/dim");
    list("biased", "mean error/sigma");
    list("correlated", "whitened innovations");
    for (const Finding& caution : verdict.cautions) add("note, " + sentence(caution));
    if (verdict.verdict == Verdict::undecided && verdict.trials_to_decide > 0)
        add("about " + number(verdict.trials_to_decide, 0) + " trials would decide");
    else if (verdict.verdict == Verdict::undecided && !verdict.findings.empty() && arm.evidence.trials > 1)
        add("every block is within the margin: only this keeps it from being consistent");
    else if (arm.evidence.trials == 0)
        add("no trial is left that could be judged");
    else if (verdict.verdict == Verdict::undecided && arm.evidence.trials == 1)
        add(arm.evidence.nis.empty() ? "one trial without innovations decides nothing: give more trials"
                                     : "the innovations of one trial do not decide: give more trials or steps");
    return text;
}

std::string verdicts_part(const Report& report) {
    int width = 16;
    for (const ArmReport& arm : report.arms)
        width = std::max(width, static_cast<int>(arm.scenario.size() + arm.arm.size()) + 3);
    std::string text = "  " + padded("", width, false) + padded("verdict", 12, false) + padded("NEES/n", 19) +
                       padded("NIS/m", 19) + padded("failed", 9) + "\n";
    for (const ArmReport& arm : report.arms) {
        text += "  " + padded(arm.scenario + "/" + arm.arm, width, false) +
                padded(verdict_name(arm.consistency.verdict), 12, false);
        for (const char* figure : {"nees_ratio", "nis_ratio"}) {
            const Summary& summary = figure_named(arm.figures, figure).summary;
            text += padded(with_interval(summary.mean, summary.ci95), 19);
        }
        text += padded(std::to_string(arm.failed), 9) + "\n" + why(arm);
    }
    return text;
}

/// The trials of a record that are in no figure, the first of them by name.
std::string troubles_part(const Report& report) {
    constexpr std::size_t most = 5;
    std::string text;
    const std::size_t shown = std::min(most, report.troubles.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const RecordTrouble& trouble = report.troubles[i];
        text += "trial " + std::to_string(trouble.trial) + ", step " + std::to_string(trouble.step + 1) + " ([" +
                std::to_string(trouble.trial) + ", " + std::to_string(trouble.step) + "] in the file): " + trouble.what + "; the trial is in no figure.\n";
    }
    const std::int64_t failed = report.arms.empty() ? 0 : report.arms.front().failed;
    if (shown > 0 && failed > static_cast<std::int64_t>(shown))
        text += "... and " + std::to_string(failed - static_cast<std::int64_t>(shown)) + " more trials.\n";
    return text;
}

/// Studies with many failed trials say so before anything else.
std::string warnings_part(const Report& report) {
    std::string text;
    for (const ArmReport& arm : report.arms) {
        const std::string name = arm.scenario + "/" + arm.arm;
        if (static_cast<double>(arm.failed) > 0.01 * static_cast<double>(arm.trials))
            text += "WARNING: " + std::to_string(arm.failed) + " of " + std::to_string(arm.trials) + " trials of " +
                    name + " failed and are left out of its figures.\n";
        if (arm.diverged > 0)
            text += "note: " + std::to_string(arm.diverged) + " trials of " + name +
                    " diverged; they are in the figures.\n";
    }
    text += troubles_part(report);
    if (!report.complete)
        text += "note: the study is not complete: it was asked for " + std::to_string(report.trials) +
                " trials of each arm.\n";
    return text;
}

}  // namespace

std::string report_text(const Report& report) {
    std::string text = warnings_part(report);
    const std::int64_t trials = report.arms.empty() ? 0 : report.arms.front().trials;
    text += report.source + ": " + std::to_string(trials) + (trials == 1 ? " trial" : " trials") +
            (report.root_seed ? " of each arm, root seed " + std::to_string(*report.root_seed) : "") +
            ".\nA consistent filter has NEES/dim 1 in every block of the state and at every step; the verdict holds all of "
            "them\nagainst 1 ± " + to_text(report.margin) + ". Intervals are two-sided 95 %.\n\n";
    text += verdicts_part(report);
    for (const Scenario& scenario : report.scenarios) text += scenario_detail(report, scenario);
    return text;
}

}  // namespace credence
