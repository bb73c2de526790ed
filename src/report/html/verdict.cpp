// The page's verdicts and findings.

#include <algorithm>
#include <cmath>
#include <credence/statistics.hpp>
#include <credence/text.hpp>
#include <map>
#include <set>

#include "base/nan.hpp"
#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

namespace credence::page {

namespace {

/// What an arm's verdict rests on, all of it; of none, the first reason why there is none.
std::string why(const ArmReport& arm) {
    if (arm.not_run()) return no_claim_text(arm);
    const std::vector<Reason> reasons = reasons_of(arm);
    if (arm.consistency.verdict == Verdict::consistent)
        return "NEES/dim of the whole state and of every group is within 1 ± " +
               to_text(arm.consistency.limits.margin) + ", the squared error of every direction within 1 ± " +
               to_text(arm.consistency.limits.direction) + " of P's, every bias within " +
               to_text(arm.consistency.limits.bias) + " sigma";
    std::vector<std::string> deciding;
    for (const Reason& reason : reasons)
        if (reason.decides) deciding.push_back(reason_text(reason));
    if (!deciding.empty()) return joined(deciding, "; ");
    return reasons.empty() ? "no interval lies wholly within the margin or wholly outside"
                           : reason_text(reasons.front());
}

/// NEES and NIS of an arm, and how many of its trials failed.
Html numbers_of(const ArmReport& arm) {
    if (arm.not_run()) return {};
    const Summary& nees = column_named(arm.columns, "nees_ratio").summary;
    const Summary& nis = column_named(arm.columns, "nis_ratio").summary;
    const double exact = arm.evidence.groups.empty() ? nan : t_test(arm.evidence.groups.front().run, 1);
    return html_of("NEES/n " + mean_cell(nees.mean, nees.ci95) +
                   (nis.count > 0 ? ", NIS/m " + mean_cell(nis.mean, nis.ci95) : Cell()) + "; " + failed_cell(arm) +
                   " of " + count_cell(static_cast<double>(arm.trials)) + " trials failed or diverged" +
                   (unseen_text(arm).empty()
                        ? Cell()
                        : ": " + number_cell_as(arm.evidence.may_be_unseen(), unseen_text(arm)) + " of all") +
                   (std::isnan(exact) ? Cell() : "; p " + p_cell(exact) + " of NEES/n being exactly 1"));
}

Html verdict_line(const ArmReport& arm) {
    return element("li", "<p class=\"arm\"><a href=\"#"_html + section_id(arm.scenario) + "\">"_html +
                             escaped(arm.scenario) + "</a> "_html + element("b", escaped(arm.arm)) + "</p>\n"_html +
                             html_of(verdict_cell(arm)) + "\n<div><p class=\"why\">"_html + escaped(why(arm)) +
                             "</p>\n<p class=\"numbers\">"_html + numbers_of(arm) + "</p></div>"_html) +
           "\n"_html;
}

Table findings_table(const std::string& caption, const std::vector<Finding>& findings) {
    Table table(caption, {"what", "where", "when", "value", "interval, corrected"});
    for (const Finding& finding : findings) {
        const double half = half_width(finding.interval);
        table.row(fault_name(finding.what), {finding.where, when_text(finding), number_cell_within(finding.value, half),
                                 interval_cell(finding.interval, decimals_for(half, finding.value))});
    }
    return table;
}

Table suspicions_table(const ArmReport& arm) {
    Table table(arm.scenario + ", " + arm.arm + ": what looks wrong and is not shown",
                {"what", "where", "value", "trials that would show it if it stays", "over the mean's 90 % interval"});
    for (const Suspicion& one : arm.consistency.suspicions)
        table.row(fault_name(one.what),
                  {one.where + ", " + one.measure, short_cell(one.value), count_cell(one.trials.value),
                   count_cell(one.trials.low) + " to " + count_cell(one.trials.high)});
    return table;
}

/// The margins that are shown, whatever was asked for.
Html reached_table(const ArmReport& arm) {
    const Reached& reached = arm.consistency.reached;
    if (std::isnan(reached.nees) && std::isnan(reached.direction) && std::isnan(reached.bias)) return {};
    const auto margin = [](double value) { return std::isnan(value) ? Cell("-") : short_cell(value); };
    Table table(arm.scenario + ", " + arm.arm + ": the margins within which it is shown to be, at 95 %",
                {"of", "margin"});
    table.row("NEES/dim", {margin(reached.nees)});
    table.row("directions", {margin(reached.direction)});
    table.row("bias in sigma", {margin(reached.bias)});
    return html_of(table);
}

/// What the truth's own errors leave open, or how large they would have to be.
Html truth_tables(const ArmReport& arm) {
    Html tables;
    if (!arm.consistency.truth.empty()) {
        Table table(arm.scenario + ", " + arm.arm + ": with the covariance R of the truth's own errors, 95 %",
                    {"group", "NEES/dim by P + R", "", "squared error over P's", "sigma of a truth that would decide"});
        for (const TruthFactor& one : arm.consistency.truth)
            table.row(one.group, {short_cell(one.nees), range_cell(one.nees95), range_cell(one.factor),
                                  short_cell(one.deciding_sigma)});
        tables += html_of(table);
    }
    if (!arm.consistency.turning_points.empty()) {
        Table table(arm.scenario + ", " + arm.arm + ": sigma of a truth with which P is not found too small",
                    {"of", "no finding from", "P is right at", "unit"});
        for (const TurningPoint& one : arm.consistency.turning_points)
            table.row(one.where, {short_cell(one.vanishes), short_cell(one.right), one.unit});
        tables += html_of(table);
    }
    return tables;
}

Html arm_findings(const ArmReport& arm) {
    constexpr std::size_t most = 8;
    const Consistency& verdict = arm.consistency;
    Html lines;
    for (const Reason& reason : reasons_of(arm)) lines += element("li", escaped(reason_text(reason)));
    if (lines.empty()) lines = element("li", escaped(why(arm)));
    std::vector<Finding> all = verdict.findings;
    all.insert(all.end(), verdict.cautions.begin(), verdict.cautions.end());
    const Html table = html_of(
        findings_table(arm.scenario + ", " + arm.arm + ": findings, and notes that do not bear on the verdict", all));
    return element("h4", escaped(arm.arm) + " "_html + html_of(verdict_cell(arm))) + "\n"_html + element("ul", lines) +
           "\n"_html +
           (all.size() <= most
                ? table
                : folded("All " + std::to_string(all.size()) + " findings of " + arm.arm + " with their intervals",
                         table)) +
           (arm.consistency.suspicions.empty() ? Html() : html_of(suspicions_table(arm))) + reached_table(arm) +
           truth_tables(arm);
}

}  // namespace

std::string column_words(const std::string& name, const std::string& unit) {
    if (name == "nees_ratio") return "NEES/n, mean over the steps";
    if (name == "nis_ratio") return "NIS/m, over the steps";
    if (name == "unseen") return "unseen features, sum over the poses";
    return with_powers(column_title(name, unit));
}

std::string verdict_counts(const Report& report) {
    if (report.arms.empty()) return "There is nothing to judge.";
    const std::string all = std::to_string(report.arms.size()), first = verdict_clause(report.arms.front());
    if (report.arms.size() == 1) return "The filter " + first + ".";
    std::map<std::pair<bool, Verdict>, int> counts;
    for (const ArmReport& arm : report.arms) ++counts[{arm.not_run(), arm.consistency.verdict}];
    std::vector<std::string> parts;
    for (const auto& [kind, count] : counts)
        parts.push_back(std::to_string(count) + " " + (kind.first ? "not run yet" : verdict_name(kind.second)));
    if (parts.size() == 1)
        return (report.arms.size() == 2 ? "Both arms " : "All " + all + " arms ") +
               (first.starts_with("is ") ? "are " + first.substr(3) : first) + ".";
    return "Of " + all + " arms " + joined(parts) + ".";
}

Html verdicts(const Report& report) {
    const std::set<std::string> swept = swept_scenarios(report);
    Html lines;
    for (const ArmReport& arm : report.arms)
        if (swept.count(arm.scenario) == 0) lines += verdict_line(arm);  // those of a sweep are in its table
    return "<section aria-labelledby=\"verdict\">\n<h2 id=\"verdict\">Verdict</h2>\n<p>A consistent filter has "
           "NEES/dim 1 "
           "in every group of components and at every step; the verdict holds all of them against 1 ± "_html +
           escaped(to_text(report.limits.margin) + ", the squared error of every direction against 1 ± " +
                   to_text(report.limits.direction) + " of what P says, and every bias against " +
                   to_text(report.limits.bias) + " sigma") +
           ". Optimistic: the filter believes itself more than its errors warrant (P too small). Pessimistic: less (P "
           "too "
           "large). Failed: more than "_html +
           escaped(short_number(100 * report.limits.failed)) +
           " % of its trials failed. Intervals are two-sided 95 %.</p>\n"_html +
           (lines.empty() ? Html() : "<ul class=\"verdicts\">\n"_html + lines + "</ul>\n"_html) + "</section>\n"_html;
}

Html findings(const Part& part) {
    Html html = "<h3>Findings</h3>\n"_html;
    for (const ArmReport* arm : part.arms) html += arm_findings(*arm);
    Html troubles;
    for (const RecordTrouble& trouble : part.report.troubles)
        troubles += element("li", escaped("trial " + std::to_string(trouble.trial) + ", step " +
                                          std::to_string(trouble.step + 1) + ": " + trouble.what));
    if (!troubles.empty())
        html += folded("Trials that failed (the first of them)", element("ul", troubles), InPrint::open);
    return html;
}

}  // namespace credence::page
