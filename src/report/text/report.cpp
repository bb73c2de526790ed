// The report as text: verdicts first, then their reasons, then the steps (src/report/text/detail.cpp).

#include <credence/report.hpp>
#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/sweep.hpp"
#include "report/text/detail.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <set>

namespace credence {

namespace {

/// The reasons for an arm's verdict; JSON has every finding with its interval.
std::string why(const ArmReport& arm) {
    constexpr std::size_t indent = 6;
    std::string text;
    for (const Reason& reason : reasons_of(arm))
        text += std::string(indent, ' ') + wrapped_list(reason.head, reason.parts, indent) + "\n";
    return text;
}

/// Arms of scenarios that are not in a sweep: a sweep has a table of its own.
std::vector<const ArmReport*> arms_by_themselves(const Report& report) {
    std::set<std::string> swept;
    for (const Scenario& scenario : report.scenarios)
        if (SweptReport::swept(scenario)) swept.insert(scenario.name);
    std::vector<const ArmReport*> arms;
    for (const ArmReport& arm : report.arms)
        if (swept.count(arm.scenario) == 0) arms.push_back(&arm);
    return arms;
}

std::string verdicts_part(const std::vector<const ArmReport*>& arms) {
    if (arms.empty()) return "";
    constexpr int widest = 56;  // longer names have a line of their own
    int width = 16;
    for (const ArmReport* arm : arms)
        width = std::clamp(static_cast<int>(arm->scenario.size() + arm->arm.size()) + 3, width, widest);
    std::string text = "  " + padded("", width, false) + padded("verdict", 12, false) + padded("NEES/n", 19) +
                       padded("NIS/m", 19) + padded("failed", 9) + "\n";
    for (const ArmReport* arm : arms) {
        const std::string name = arm->scenario + "/" + arm->arm;
        const bool fits = static_cast<int>(name.size()) < width;
        text += (fits ? "" : "  " + name + "\n") + "  " + padded(fits ? name : "", width, false) +
                padded(verdict_word(*arm), 12, false);
        for (const char* column : {"nees_ratio", "nis_ratio"}) {
            const Summary& summary = column_named(arm->columns, column).summary;
            text += padded(with_interval(summary.mean, summary.ci95), 19);
        }
        text += padded(arm->not_run() ? "-" : std::to_string(arm->failed_trials()), 9) + "\n" + why(*arm);
    }
    return text;
}

}  // namespace

std::string report_text(const Report& report) {
    std::string text;
    for (const std::string& warning : warnings_of(report)) text += wrapped(warning) + "\n";
    text += report.source + ": " + trials_text(report) +
            ".\nA consistent filter has NEES/dim 1 in every group of components and at every step, and errors as large as P says in\n"
            "every direction. The verdict holds them against 1 ± " + to_text(report.limits.margin) + " and 1 ± " +
            to_text(report.limits.direction) + ". Intervals are two-sided 95 %.\n\n";
    const std::vector<const ArmReport*> arms = arms_by_themselves(report);
    text += verdicts_part(arms);
    for (const Scenario& scenario : report.scenarios)
        if (!SweptReport::swept(scenario)) text += scenario_detail(report, scenario);
    const std::string sweeps = sweep_text(report);
    return text + (sweeps.empty() || arms.empty() ? "" : "\n") + sweeps;
}

}  // namespace credence
