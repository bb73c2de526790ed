// A budget as one page: for each arm the bars of what its sources contribute, beside what P counts, and its tables.

#include "report/budget.hpp"

#include "report/format.hpp"
#include "report/html/charts/chart.hpp"
#include "report/html/page.hpp"

#include <cmath>

namespace credence {

namespace {

using namespace page;

/// Of each source the contribution alone with its interval, and what P counts.
Html bars(const BudgetPart& part, const std::string& id, bool counts) {
    constexpr double width = 520, left = 110, right = width - 14, top = 8, row = 30;
    const double bottom = top + row * static_cast<double>(part.contributions.size());
    Range range{0, part.rmse, true};
    for (const Contribution& one : part.contributions)
        for (const double value : {one.alone95.high, one.p_counts}) range.include(value);
    Svg svg(width, bottom + 36);
    const Axes axes{scale_between(ScaleKind::linear, 0, 1.04 * range.high, left, right),
                    {ScaleKind::linear, 0, 1, bottom, top},
                    name_with_unit(part), "", 6, 0};
    axes.draw(svg);
    double y = top;
    for (const Contribution& one : part.contributions) {
        const double alone = std::isnan(one.alone) ? 0 : one.alone;
        svg.text({left - 8, y + row / 2 + 4}, Anchor::end, shortened(one.source, 14), "label row");
        svg.box({left, y + 5}, {axes.x(alone), y + 15}, "bar s0", one.source + " alone: " + short_number(alone));
        svg.line({axes.x(one.alone95.low), y + 10}, {axes.x(one.alone95.high), y + 10}, "whisker",
                 "95 %: " + short_number(one.alone95.low) + " to " + short_number(one.alone95.high));
        if (counts && !std::isnan(one.p_counts))
            svg.box({left, y + 17}, {axes.x(one.p_counts), y + 25}, "bar s1",
                    one.source + ", P counts: " + short_number(one.p_counts));
        y += row;
    }
    return chart("What each source contributes alone, with its 95 % interval" +
                     std::string(counts ? "; below it what P counts." : "."),
                 svg.html(id, "contributions to " + part.name, "The table below has the numbers."));
}

Html part_table(const BudgetPart& part, bool counts) {
    std::vector<std::string> heads{"source", "alone", "95 %", "share", "with others"};
    if (counts) heads.insert(heads.end(), {"P counts", "error²/P's"});
    Table table(name_with_unit(part), heads);
    for (const Contribution& one : part.contributions) {
        const Cell alone = std::isnan(one.alone) ? Cell("< " + short_number(one.alone95.high)) : short_cell(one.alone);
        std::vector<Cell> cells{alone, range_cell(one.alone95), one.share >= 0 ? share_cell(one.share) : Cell("-"),
                                short_cell(one.with_others)};
        if (counts) cells.insert(cells.end(), {short_cell(one.p_counts), share_cell(one.ratio)});
        table.row(one.source, cells);
    }
    table.row("mean error", {short_cell(part.mean)});
    table.row("together", {short_cell(part.rss), "RMSE " + short_number(part.rmse)});
    if (!std::isnan(part.p_says)) table.row("P says", {short_cell(part.p_says), "", share_cell(part.ratio)});
    return html_of(table);
}

}  // namespace

std::string budget_html(const BudgetReport& report, const std::string& made_by) {
    Html body;
    for (std::size_t i = 0; i < report.arms.size(); ++i) {
        const ArmBudget& arm = report.arms[i];
        const bool counts = arm.counted_trials > 0;
        const Html id = "arm:"_html + escaped(std::to_string(i));
        Html tables;
        for (const BudgetPart& part : arm.parts) tables += part_table(part, counts);
        body += section(id, escaped(arm.scenario + "/" + arm.arm),
                        element("p", escaped("Errors " + arm_sentence(arm) + ".")) +
                            bars(part_of(arm, report.of), "bars." + std::to_string(i), counts) + tables);
    }
    const Html header =
        "<h1>Why is the error what it is?</h1>\n"_html +
        element("p", escaped("Each source of noise was drawn anew with all others held. Root seed " +
                             std::to_string(report.root_seed) + ". Page made by " + made_by + "."));
    return document("credence: budget", header, body);
}

}  // namespace credence
