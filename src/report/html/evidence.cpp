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
Html by_arm(const Part& part, HtmlTable table, const AddRows& add_rows) {
    bool any = false;
    for (const ArmReport* arm : part.arms) {
        if (arm->evidence.trials == 0) continue;
        HtmlTable rows("", {});
        add_rows(arm->evidence, rows);
        if (rows.empty()) continue;
        if (part.arms.size() > 1) table.group(arm->arm);
        add_rows(arm->evidence, table);
        any = true;
    }
    return any ? table.html() : Html();
}

Html blocks_table(const Part& part) {
    HtmlTable table(
        part.scenario.name + ": blocks of the state, over all steps, and how many steps are outside their bands",
        {"block", "dimension", "NEES/dim", "95 %", "standard error", "out of joint band", "out of own band", "var/2dim",
         "RMSE", "RMSE/sigma", "95 %", "bound on NEES' rounding"});
    return by_arm(part, table, [](const Evidence& evidence, HtmlTable& rows) {
        for (const GroupEvidence* block : shown_blocks(evidence)) {
            const Interval over_steps = over_steps95(*block);
            const int digits = decimals_for(half_width(over_steps)),
                      ratio_digits = decimals_for(half_width(block->accuracy.ratio_ci95));
            rows.row(
                escaped(block->block),
                {count_html(block->dimension), number_html(block->run.mean, digits), interval_html(over_steps, digits),
                 number_html_within(block->run.standard_error, block->run.standard_error),
                 escaped(of_steps(block->anees.outside_simultaneous, block->anees.observed)),
                 escaped(of_steps(block->anees.outside, block->anees.observed)),
                 escaped(number(mean_of(block->variance_ratio), 2)), number_html(block->accuracy.over_steps, 4),
                 number_html(block->accuracy.ratio, ratio_digits),
                 interval_html(block->accuracy.ratio_ci95, ratio_digits),
                 number_html_as(block->rounding, short_number(block->rounding))});
        }
    });
}

/// Names the component groups that have no rows of their own.
Html omitted_blocks(const Part& part) {
    std::size_t omitted = 0;
    for (const ArmReport* arm : part.arms)
        omitted = std::max(omitted, arm->evidence.blocks.size() - shown_blocks(arm->evidence).size());
    if (omitted == 0) return {};
    return element("p", escaped(std::to_string(omitted) + " more blocks of each arm are nearer to 1; JSON has all.")) +
           "\n"_html;
}

Html charts_table(const Part& part) {
    const HtmlTable table(
        part.scenario.name + ": NEES with the error in another chart and the same covariance; the verdict is without it",
        {"block", "chart", "NEES/dim", "95 %", "standard error", "out of joint band", "out of own band"});
    return by_arm(part, table, [](const Evidence& evidence, HtmlTable& rows) {
        for (const ChartEvidence& chart : evidence.charts) {
            const Interval over_steps = t_interval(chart.run);
            const int digits = decimals_for(half_width(over_steps));
            rows.row(escaped(chart.block),
                     {escaped(chart.chart), number_html(chart.run.mean, digits), interval_html(over_steps, digits),
                      number_html_within(chart.run.standard_error, chart.run.standard_error),
                      escaped(of_steps(chart.anees.outside_simultaneous, chart.anees.observed)),
                      escaped(of_steps(chart.anees.outside, chart.anees.observed))});
        }
    });
}

Html coverage_table(const Part& part) {
    std::vector<std::string> heads{"block"};
    for (const double level : coverage_levels) heads.push_back(to_text(100 * level) + " % covers");
    const HtmlTable table(part.scenario.name +
                              ": coverage, the share of trials whose NEES is below that quantile of chi-square, "
                              "mean over the steps",
                          heads);
    return by_arm(part, table, [](const Evidence& evidence, HtmlTable& rows) {
        for (const GroupEvidence* block : shown_blocks(evidence)) {
            std::vector<Html> cells;
            for (const Coverage& level : block->coverage)
                cells.push_back(number_html_as(level.over_steps, number(100 * level.over_steps, 1) + " %"));
            rows.row(escaped(block->block), cells);
        }
    });
}

Html nis_table(const Part& part) {
    const HtmlTable table(
        part.scenario.name +
            ": innovations, ΣNIS/Σm over all trials and steps, and how many steps are outside their bands",
        {"rows", "Σm", "NIS/m", "95 %", "factor on S, 95 %", "out of joint band", "out of own band"});
    return by_arm(part, table, [](const Evidence& evidence, HtmlTable& rows) {
        for (const NisEvidence& nis : evidence.nis) {
            const double half = half_width(std::isnan(nis.ratio95.low) ? nis.scale95 : nis.ratio95);
            const int digits = decimals_for(half);
            rows.row(escaped(nis.part), {count_html(nis.degrees), number_html(nis.ratio, digits),
                                         interval_html(nis.ratio95, digits), interval_html(nis.scale95, digits + 1),
                                         escaped(of_steps(nis.nis.outside_simultaneous, nis.nis.observed)),
                                         escaped(of_steps(nis.nis.outside, nis.nis.observed))});
        }
    });
}

Html whiteness_table(const Part& part) {
    const HtmlTable table(part.scenario.name + ": whiteness, the correlation of innovations a lag apart",
                          {"lag", "correlation", "over NIS/m", "white within", "jointly within", "products"});
    return by_arm(part, table, [](const Evidence& evidence, HtmlTable& rows) {
        for (const Whiteness& lag : evidence.whiteness) {
            const int digits = decimals_for(lag.bound);
            rows.row(
                count_html(lag.lag),
                {number_html(lag.correlation, digits), number_html(lag.scaled, digits), "± "_html + number_html(lag.bound, digits),
                 "± "_html + number_html(lag.simultaneous_bound, digits), count_html(static_cast<double>(lag.count))});
        }
    });
}

Html distribution_table(const Part& part) {
    HtmlTable table(part.scenario.name + ": shape of the NEES and credibility",
                    {"arm", "distance from chi-square", "at step", "p over all steps", "NCI", "I²", "of these trials"});
    for (const ArmReport* arm : part.arms) {
        const WorstDistribution worst = worst_distribution(arm->evidence.shape);
        const CredibilityEvidence& credibility = arm->evidence.credibility;
        if (worst.known == 0 && std::isnan(credibility.nci)) continue;
        std::int64_t trials = 0;
        for (const Credibility& step : credibility.step) trials = std::max(trials, step.count);
        const bool known = worst.known > 0;
        table.row(escaped(arm->arm),
                  {known ? number_html(worst.distance, 4) : "-"_html, known ? count_html(worst.step) : "-"_html,
                   known ? escaped(p_text(worst.p)) : "-"_html, number_html(credibility.nci, 3),
                   number_html(credibility.inclination, 3), count_html(static_cast<double>(trials))});
    }
    return table.html();
}

}  // namespace

Html evidence_tables(const Part& part) {
    const Html html = blocks_table(part) + omitted_blocks(part) + charts_table(part) + coverage_table(part) + nis_table(part) +
                      distribution_table(part) + folded("Whiteness of the innovations, lag by lag", whiteness_table(part)) +
                      direction_tables(part) + worst_trials_table(part);
    return html.empty() ? html : "<h3>Is the covariance right?</h3>\n"_html + html;
}

}  // namespace credence::page
