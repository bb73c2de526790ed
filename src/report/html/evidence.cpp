// The page's tables of an arm's evidence: its errors and innovations.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/words.hpp"

#include <cmath>

namespace credence::page {

namespace {

/// A table whose rows are grouped by arm.
template <class AddRows>
Html by_arm(const Part& part, Table table, const AddRows& add_rows) {
    for (const ArmReport* arm : part.arms) {
        if (arm->evidence.trials == 0) continue;
        Table rows("", {});
        add_rows(arm->evidence, rows);
        if (part.arms.size() > 1 && !rows.empty()) table.group(arm->arm);
        for (const Table::Row& row : rows.rows()) table.row(row.cells);
    }
    return html_of(table);
}

Html groups_table(const Part& part) {
    Table table(
        part.scenario.name + ": groups of the state, over all steps, and how many steps are outside their bands",
        {"group", "dimension", "NEES/dim", "95 %", "standard error", "out of joint band", "out of own band", "var/2dim",
         "RMSE", "RMSE/sigma", "95 %", "bound on NEES' rounding"});
    return by_arm(part, table, [](const Evidence& evidence, Table& rows) {
        for (const GroupEvidence* group : shown_groups(evidence)) {
            const Interval over_steps = over_steps95(*group);
            const int digits = decimals_for(half_width(over_steps), group->run.mean),
                      ratio_digits = decimals_for(half_width(group->accuracy.ratio_ci95), group->accuracy.ratio);
            rows.row(
                group->name,
                {count_cell(group->dimension), number_cell(group->run.mean, digits), interval_cell(over_steps, digits),
                 number_cell_within(group->run.standard_error, group->run.standard_error),
                 of_steps(group->anees.outside_simultaneous, group->anees.observed),
                 of_steps(group->anees.outside, group->anees.observed), number_cell(mean_of(group->variance_ratio), 2),
                 number_cell(group->accuracy.over_steps, 4), number_cell(group->accuracy.ratio, ratio_digits),
                 interval_cell(group->accuracy.ratio_ci95, ratio_digits), count_cell(group->rounding)});
            if (const Moments& run = group->without_diverged; run.count > 0)
                rows.row(group->name + " without diverged trials",
                         {count_cell(group->dimension), number_cell(run.mean, digits),
                          interval_cell(t_interval(run), digits),
                          number_cell_within(run.standard_error, run.standard_error), "", "", "", "", "", "", ""});
        }
    });
}

/// Names the component groups that have no rows of their own.
Html omitted_groups(const Part& part) {
    std::size_t omitted = 0;
    for (const ArmReport* arm : part.arms)
        omitted = std::max(omitted, arm->evidence.groups.size() - shown_groups(arm->evidence).size());
    if (omitted == 0) return {};
    return element("p", escaped(std::to_string(omitted) + " more groups of each arm are nearer to 1; JSON has all.")) +
           "\n"_html;
}

Html charts_table(const Part& part) {
    const Table table(part.scenario.name +
                          ": NEES with the error in another chart and the same covariance; the verdict is without it",
                      {"group", "chart", "NEES/dim", "95 %", "standard error", "out of joint band", "out of own band"});
    return by_arm(part, table, [](const Evidence& evidence, Table& rows) {
        for (const ChartEvidence& chart : evidence.charts) {
            const Interval over_steps = t_interval(chart.run);
            const int digits = decimals_for(half_width(over_steps), chart.run.mean);
            rows.row(chart.name, {chart.chart, number_cell(chart.run.mean, digits), interval_cell(over_steps, digits),
                                  number_cell_within(chart.run.standard_error, chart.run.standard_error),
                                  of_steps(chart.anees.outside_simultaneous, chart.anees.observed),
                                  of_steps(chart.anees.outside, chart.anees.observed)});
        }
    });
}

Html coverage_table(const Part& part) {
    std::vector<std::string> heads{"group"};
    for (const double level : coverage_levels) heads.push_back(to_text(100 * level) + " % covers");
    const Table table(part.scenario.name +
                              ": coverage, the share of trials whose NEES is below that quantile of chi-square, "
                              "mean over the steps",
                          heads);
    return by_arm(part, table, [](const Evidence& evidence, Table& rows) {
        for (const GroupEvidence* group : shown_groups(evidence)) {
            std::vector<Cell> cells;
            for (const Coverage& level : group->coverage)
                cells.push_back(number_cell_as(level.over_steps, number(100 * level.over_steps, 1) + " %"));
            rows.row(group->name, cells);
        }
    });
}

Html nis_table(const Part& part) {
    const Table table(
        part.scenario.name +
            ": innovations, ΣNIS/Σm over all trials and steps, and how many steps are outside their bands",
        {"rows", "Σm", "NIS/m", "95 %", "factor on S, 95 %", "out of joint band", "out of own band"});
    return by_arm(part, table, [](const Evidence& evidence, Table& rows) {
        for (const NisEvidence& nis : evidence.nis) {
            const double half = half_width(std::isnan(nis.ratio95.low) ? nis.scale95 : nis.ratio95);
            const int digits = decimals_for(half, nis.ratio);
            rows.row(nis.part, {count_cell(nis.degrees), number_cell(nis.ratio, digits),
                                         interval_cell(nis.ratio95, digits), interval_cell(nis.scale95, digits + 1),
                                         of_steps(nis.nis.outside_simultaneous, nis.nis.observed),
                                         of_steps(nis.nis.outside, nis.nis.observed)});
        }
    });
}

Html whiteness_table(const Part& part) {
    const Table table(part.scenario.name + ": whiteness, the correlation of innovations a lag apart",
                          {"lag", "correlation", "over NIS/m", "white within", "jointly within", "products"});
    return by_arm(part, table, [](const Evidence& evidence, Table& rows) {
        for (const Whiteness& lag : evidence.whiteness) {
            const int digits = decimals_for(lag.bound);
            rows.row(count_cell(lag.lag),
                     {number_cell(lag.correlation, digits), number_cell(lag.scaled, digits),
                      "± " + number_cell(lag.bound, digits), "± " + number_cell(lag.simultaneous_bound, digits),
                      count_cell(static_cast<double>(lag.count))});
        }
    });
}

Html distribution_table(const Part& part) {
    Table table(part.scenario.name + ": distribution of the NEES, and credibility",
                    {"arm", "distance from chi-square", "at step", "p over all steps", "NCI", "I²", "of these trials"});
    for (const ArmReport* arm : part.arms) {
        if (arm->evidence.trials == 1) continue;  // one value at a step has no distribution
        const WorstDistribution worst = worst_distribution(arm->evidence.distribution);
        const CredibilityEvidence& credibility = arm->evidence.credibility;
        if (worst.known == 0 && std::isnan(credibility.nci)) continue;
        std::int64_t trials = 0;
        for (const Credibility& step : credibility.step) trials = std::max(trials, step.count);
        const bool known = worst.known > 0;
        table.row(arm->arm,
                  {known ? number_cell(worst.distance, 4) : Cell("-"), known ? count_cell(worst.step) : Cell("-"),
                   known ? p_cell(worst.p) : Cell("-"), number_cell(credibility.nci, 3),
                   number_cell(credibility.inclination, 3), count_cell(static_cast<double>(trials))});
    }
    return html_of(table);
}

}  // namespace

Html evidence_tables(const Part& part) {
    const Html html = groups_table(part) + omitted_groups(part) + charts_table(part) + coverage_table(part) +
                      nis_table(part) + distribution_table(part) +
                      folded("Whiteness of the innovations, lag by lag", whiteness_table(part)) +
                      direction_tables(part) + worst_trials_table(part);
    return html.empty() ? html : "<h3>Is the covariance right?</h3>\n"_html + html;
}

}  // namespace credence::page
