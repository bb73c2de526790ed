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

/// The reasons for an arm's verdict, in lines below its row; JSON has every finding with its interval.
std::string why(const ArmReport& arm) {
    constexpr std::size_t indent = 6;
    std::vector<std::string> lines;
    for (const Reason& reason : reasons_of(arm))
        lines.push_back("    " + wrapped_list(reason.head, reason.parts, indent));
    return joined(lines, "\n  ");
}

/// Arms of scenarios that are not in a sweep: a sweep has a table of its own.
std::vector<const ArmReport*> arms_by_themselves(const Report& report) {
    const std::set<std::string> swept = swept_scenarios(report);
    std::vector<const ArmReport*> arms;
    for (const ArmReport& arm : report.arms)
        if (swept.count(arm.scenario) == 0) arms.push_back(&arm);
    return arms;
}

std::string verdicts_part(const std::vector<const ArmReport*>& arms) {
    Table table("", {"", "verdict", "NEES/n", "NIS/m", "failed or diverged"});
    for (const ArmReport* arm : arms) {
        std::vector<Cell> cells{arm->scenario + "/" + arm->arm, verdict_cell(*arm)};
        for (const char* column : {"nees_ratio", "nis_ratio"}) {
            const Summary& summary = column_named(arm->columns, column).summary;
            cells.push_back(mean_cell(summary.mean, summary.ci95));
        }
        const std::string unseen = unseen_text(*arm);
        cells.push_back(failed_cell(*arm) + (unseen.empty() ? "" : " (" + unseen + ")"));
        table.row(std::move(cells));
        if (const std::string reasons = why(*arm); !reasons.empty()) table.group(reasons);
    }
    return table_text(table);
}

/// The tables by point.
std::string sweeps_part(const Report& report) {
    std::string text;
    for (const Grid& grid : grids_of(report)) {
        std::vector<std::string> keys;
        for (std::size_t k = 0; k < grid.keys.size(); ++k) {
            std::set<std::string> values;
            for (const auto& [name, point] : grid.points) values.insert(point->sweep.at[k].value);
            keys.push_back(grid.keys[k] + " (" + std::to_string(values.size()) + " values)");
        }
        text += wrapped("sweep of " + grid.of + " over " + joined(keys) + ": mean ± 95 %") + "\n";
        for (const SweptTable& one : tables_of(report, grid)) text += "  " + one.head + "\n" + table_text(one.table, 4);
        text += "\n";
    }
    return text.empty() ? text
                        : text + "Of each point by itself, --format html, json and csv have all that was found.\n";
}

}  // namespace

std::string report_text(const Report& report) {
    std::string text;
    for (const std::string& warning : warnings_of(report)) text += wrapped(warning) + "\n";
    text += report.source + ": " + trials_text(report) + ".\n";
    text +=
        "A consistent filter has NEES/dim 1 in every group of components and at every step, and errors as large as P ";
    text += "says in\nevery direction. The verdict holds them against 1 ± " + to_text(report.limits.margin) +
            " and 1 ± " + to_text(report.limits.direction) + ". Intervals are two-sided 95 %.\n\n";
    const std::vector<const ArmReport*> arms = arms_by_themselves(report);
    text += verdicts_part(arms);
    for (const Scenario& scenario : report.scenarios)
        if (!is_swept(scenario)) text += scenario_detail(report, scenario);
    const std::string sweeps = sweeps_part(report);
    return text + (sweeps.empty() || arms.empty() ? "" : "\n") + sweeps;
}

}  // namespace credence
