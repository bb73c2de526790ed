// The report as text: verdicts first, then their reasons, then each scenario by itself.

#include <credence/report.hpp>
#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>
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

std::string published_text(const PublishedPlace& published) {
    if (!std::isfinite(published.percentile)) return to_text(published.value);
    return to_text(published.value) + " (" + number(published.percentile, 1) + " %)";
}

std::vector<Cell> column_cells(const std::string& label, const Summary& s, const std::optional<Interval>& bootstrap,
                               const std::string& last) {
    const int digits = decimals_for(half_width(s.ci95), s.mean);
    return {label, mean_cell(s.mean, s.ci95), bootstrap ? interval_cell(*bootstrap, digits) : Cell(),
            number_cell(s.median, digits), number_cell(s.standard_deviation, digits), last};
}

/// Adds the rows of the arms and of their differences.
void add_column(Table& table, const Report& report, const std::string& scenario, const std::string& name) {
    bool any = false;
    for (const ArmReport& arm : report.arms) {
        if (arm.scenario != scenario) continue;
        const ColumnReport& column = column_named(arm.columns, name);
        if (column.name != name || column.summary.count == 0) continue;
        if (!any) table.group("  " + column_title(name, column.unit));
        any = true;
        table.row(column_cells("    " + arm.arm, column.summary, column.bootstrap95,
                               column.published ? published_text(*column.published) : ""));
    }
    for (const Comparison& pair : report.pairs)
        for (const ComparedColumn& column : pair.columns) {
            const PairedComparison& paired = column.paired;
            if (pair.scenario != scenario || column.name != name || paired.pairs == 0) continue;
            table.row(column_cells("    " + controller_of(pair.a) + " - " + controller_of(pair.b), paired.difference,
                                   paired.bootstrap95, percent(paired.wins_a) + " below"));
        }
}

std::string groups_part(const ArmReport& arm, const std::vector<const GroupEvidence*>& groups) {
    Table table("", {arm.arm, "NEES/dim", "steps out", "95 % covers", "var/2dim", "RMSE/sigma"});
    for (const GroupEvidence* group : groups)
        table.row({"  " + group->name, mean_cell(group->run.mean, over_steps95(*group)),
                   of_steps(group->anees.outside_simultaneous, group->anees.observed),
                   number_cell_as(group->coverage[2].over_steps, number(100 * group->coverage[2].over_steps, 1) + " %"),
                   number_cell(mean_of(group->variance_ratio), 2),
                   mean_cell(group->accuracy.ratio, group->accuracy.ratio_ci95)});
    return table_text(table);
}

/// NEES in other charts, after the groups' own.
std::string charts_part(const Evidence& evidence) {
    std::string text;
    for (std::size_t first = 0; first < evidence.charts.size();) {
        const std::string chart = evidence.charts[first].chart;
        std::vector<std::string> parts;
        for (; first < evidence.charts.size() && evidence.charts[first].chart == chart; ++first) {
            const ChartEvidence& one = evidence.charts[first];
            parts.push_back(one.name + " " + with_interval(one.run.mean, t_interval(one.run)));
        }
        text += "    " + wrapped_list("NEES/dim in the " + chart + " chart, not judged:", parts, 4) + "\n";
    }
    return text;
}

std::string innovations_part(const Evidence& evidence) {
    std::vector<std::string> parts;
    for (const NisEvidence& nis : evidence.nis)
        parts.push_back(nis.part + " " + number(nis.ratio, 4) + " (outside its band at " +
                        of_steps(nis.nis.outside_simultaneous, nis.nis.observed) + " steps)");
    std::string text = parts.empty() ? "" : "    " + wrapped_list("ΣNIS/Σm:", parts, 4) + "\n";
    if (evidence.whiteness.empty()) return text;
    const Whiteness& first = evidence.whiteness.front();
    if (!first.known()) return text + "    innovations: their correlation could not be computed\n";
    const int outside = lags_outside(evidence.whiteness);
    return text + "    " +
           wrapped("innovations: correlation " + number(first.scaled, 4) + " at lag " + std::to_string(first.lag) +
                       " (white within ± " + number(first.bound, 4) + "); " +
                       of_steps(outside, static_cast<int>(evidence.whiteness.size())) +
                       " lags outside their joint bounds",
                   4) +
           "\n";
}

std::string distribution_part(const Evidence& evidence) {
    if (evidence.trials == 1) return "";  // one value at a step has no distribution
    std::string text;
    if (const WorstDistribution worst = worst_distribution(evidence.distribution); worst.known > 0)
        text += "    NEES against chi-square: distance " + number(worst.distance, 4) + " at step " +
                std::to_string(worst.step) + " (p " + (worst.p < 1e-4 ? "< 0.0001" : number(worst.p, 4)) +
                " over all " + std::to_string(worst.known) + " steps)\n";
    if (std::isfinite(evidence.credibility.nci) && std::isfinite(evidence.credibility.inclination))
        text += "    NCI " + number(evidence.credibility.nci, 3) + ", I² " +
                number(evidence.credibility.inclination, 3) +
                (evidence.credibility.inclination > 0 ? " (> 0: optimistic)\n" : " (< 0: pessimistic)\n");
    return text;
}

std::string consistency_part(const ArmReport& arm) {
    if (arm.evidence.groups.empty() || arm.evidence.trials == 0) return "";
    const std::vector<const GroupEvidence*> groups = shown_groups(arm.evidence);
    std::string text = groups_part(arm, groups);
    if (const std::size_t more = arm.evidence.groups.size() - groups.size(); more > 0)
        text += "    (" + std::to_string(more) + (more == 1 ? " more group is" : " more groups are") +
                " nearer to 1; JSON has all)\n";
    return text + charts_part(arm.evidence) + innovations_part(arm.evidence) + distribution_part(arm.evidence);
}

bool has_published(const Report& report, const std::string& scenario) {
    for (const ArmReport& arm : report.arms)
        for (const ColumnReport& column : arm.columns)
            if (arm.scenario == scenario && column.published) return true;
    return false;
}

/// The columns of a scenario's trials, trace(P) at the end and over the run first; the ratios are shown beside the
/// verdict.
std::vector<std::string> detailed_columns(const Report& report, const std::string& scenario) {
    std::vector<std::string> names{"trace_P", "mean_trace_P"};
    for (const ArmReport& arm : report.arms)
        for (const ColumnReport& column : arm.columns)
            if (arm.scenario == scenario && column.name != "nees_ratio" && column.name != "nis_ratio" &&
                std::find(names.begin(), names.end(), column.name) == names.end())
                names.push_back(column.name);
    return names;
}

/// A mean with its interval, which is only rounding where all trials have the same value.
Cell step_cell(const Moments& moments) {
    const Interval interval = t_interval(moments);
    const bool rounding = half_width(interval) < 1e-8 * std::abs(moments.mean);
    return mean_cell(moments.mean, rounding ? Interval{moments.mean, moments.mean} : interval);
}

/// trace(P) and the squared error of the whole state, which are equal in the mean if the filter is consistent, at the
/// first step, the last and some between them.
std::string steps_part(const Report& report, const std::string& scenario) {
    std::vector<const ArmReport*> arms;
    for (const ArmReport& arm : report.arms)
        if (arm.scenario == scenario && arm.evidence.trials > 0 && !arm.evidence.groups.empty() &&
            !arm.evidence.groups.front().accuracy.square.empty())
            arms.push_back(&arm);
    if (arms.empty()) return "";
    const std::size_t steps = arms.front()->evidence.groups.front().accuracy.square.size(),
                      shown = std::min<std::size_t>(steps, 5);
    std::vector<std::size_t> at;
    std::vector<std::string> heads{"by step"};
    for (std::size_t i = 0; i < shown; ++i) {
        at.push_back(shown == 1 ? 0 : (i * (steps - 1) + (shown - 1) / 2) / (shown - 1));
        heads.push_back(std::to_string(at.back() + 1));
    }
    Table table("", heads);
    for (const auto& [what, by_step] :
         {std::pair("trace(P)", &Accuracy::variance), std::pair("squared error", &Accuracy::square)}) {
        table.group("  " + column_title(what, arms.front()->evidence.groups.front().accuracy.unit));
        for (const ArmReport* arm : arms) {
            std::vector<Cell> cells{"    " + arm->arm};
            for (const std::size_t k : at) {
                const std::vector<Moments>& moments = arm->evidence.groups.front().accuracy.*by_step;
                if (k < moments.size()) cells.push_back(step_cell(moments[k]));
                else cells.emplace_back();
            }
            table.row(std::move(cells));
        }
    }
    return table_text(table, 0);
}

/// Columns of the arms and their paired differences, and the steps at which each arm's filter is inconsistent.
std::string scenario_detail(const Report& report, const Scenario& scenario) {
    std::string text = "\n" + wrapped(scenario.name + (scenario.title.empty() ? "" : ": " + scenario.title)) + "\n";
    if (!has_run(report, scenario.name)) return text + "  not run yet\n";
    Table table("", {"", "mean ± 95 %", "bootstrap 95 %", "median", "sd",
                     has_published(report, scenario.name) ? "published (pctl.)" : ""});
    for (const std::string& name : detailed_columns(report, scenario.name))
        add_column(table, report, scenario.name, name);
    text += table_text(table, 0) + steps_part(report, scenario.name);
    for (const ArmReport& arm : report.arms)
        if (arm.scenario == scenario.name) text += consistency_part(arm);
    return text;
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
