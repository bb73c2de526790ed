// The page's tables by step: every value that the charts draw, and those behind the findings.

#include <cmath>
#include <credence/text.hpp>
#include <numeric>

#include "report/format.hpp"
#include "report/html/charts/chart.hpp"
#include "report/html/page.hpp"
#include "report/words.hpp"

namespace credence::page {

namespace {

constexpr std::size_t most_rows = 60;

/// The caption, and how many of the steps have a row.
std::string captioned(const std::string& caption, std::size_t count) {
    if (count <= most_rows) return caption;
    return caption + " (every " + std::to_string((count + most_rows - 1) / most_rows) + " steps; JSON has all)";
}

/// A row for each of these steps, or for some of them.
template <class Cells>
Html by_step(const std::string& caption, const std::vector<std::size_t>& steps, std::vector<std::string> heads,
             const Cells& cells) {
    heads.insert(heads.begin(), "step");
    Table table(captioned(caption, steps.size()), std::move(heads));
    for (const std::size_t i : thinned(steps.size(), most_rows))
        table.row(std::to_string(steps[i] + 1), cells(steps[i]));
    return html_of(table);
}

template <class Cells>
Html by_step(const std::string& caption, int steps, std::vector<std::string> heads, const Cells& cells) {
    std::vector<std::size_t> all(static_cast<std::size_t>(steps));
    std::iota(all.begin(), all.end(), std::size_t{0});
    return by_step(caption, all, std::move(heads), cells);
}

std::string name_of(const ArmReport& arm) { return arm.scenario + ", " + arm.arm; }

/// The value at a step, or NaN where the list has none.
double at(const std::vector<double>& values, std::size_t k) { return k < values.size() ? values[k] : std::nan(""); }

Html group_table(const ArmReport& arm, const GroupEvidence& group) {
    std::vector<std::string> heads{"NEES/dim",        "standard error", "degrees", "band 95 %",
                                   "joint band 95 %", "var/2dim",       "RMSE",    "predicted"};
    for (const Coverage& level : group.coverage) {
        heads.push_back(to_text(100 * level.level) + " % covers");
        heads.push_back("Wilson 95 %");
    }
    return by_step(name_of(arm) + ": group " + group.name + " by step", arm.evidence.steps, heads, [&](std::size_t k) {
        std::vector<Cell> cells{short_cell(group.anees.ratio[k]),
                                short_cell(group.step[k].standard_error),
                                short_cell(group.anees.degrees[k]),
                                range_cell(group.anees.band[k]),
                                range_cell(group.anees.simultaneous_band[k]),
                                short_cell(group.variance_ratio[k]),
                                short_cell(at(group.accuracy.rmse, k)),
                                short_cell(at(group.accuracy.predicted, k))};
        for (const Coverage& level : group.coverage) {
            cells.push_back(short_cell(level.share[k]));
            cells.push_back(range_cell(level.interval[k]));
        }
        return cells;
    });
}

Html chart_table(const ArmReport& arm, const ChartEvidence& chart) {
    return by_step(name_of(arm) + ": NEES of " + chart.name + " in the " + chart.chart + " chart by step",
                   arm.evidence.steps, {"NEES/dim", "standard error", "degrees", "band 95 %", "joint band 95 %"},
                   [&](std::size_t k) -> std::vector<Cell> {
                       return {short_cell(chart.anees.ratio[k]), short_cell(chart.step[k].standard_error),
                               short_cell(chart.anees.degrees[k]), range_cell(chart.anees.band[k]),
                               range_cell(chart.anees.simultaneous_band[k])};
                   });
}

Html nis_table(const ArmReport& arm, const NisEvidence& nis) {
    return by_step(name_of(arm) + ": NIS of the rows " + nis.part + " by step", observed(nis.nis.ratio),
                   {"NIS/m", "Σm", "band 95 %", "joint band 95 %"}, [&](std::size_t k) -> std::vector<Cell> {
                       return {short_cell(nis.nis.ratio[k]), short_cell(nis.nis.degrees[k]),
                               range_cell(nis.nis.band[k]), range_cell(nis.nis.simultaneous_band[k])};
                   });
}

Html bias_table(const ArmReport& arm) {
    std::vector<std::string> heads;
    for (const BiasEvidence& bias : arm.evidence.bias) heads.push_back(bias.component);
    if (heads.empty()) return {};
    return by_step(name_of(arm) + ": mean error/sigma by component and step (standard error)", arm.evidence.steps,
                   heads, [&](std::size_t k) {
                       std::vector<Cell> cells;
                       for (const BiasEvidence& bias : arm.evidence.bias)
                           cells.push_back(short_cell(bias.step[k].mean) + " (" +
                                           short_cell(bias.step[k].standard_error) + ")");
                       return cells;
                   });
}

Html distribution_table(const ArmReport& arm) {
    const Evidence& evidence = arm.evidence;
    return by_step(name_of(arm) + ": distance of the NEES from chi-square, and credibility, by step", evidence.steps,
                   {"distance", "p", "NCI", "I²"}, [&](std::size_t k) -> std::vector<Cell> {
                       const bool known = k < evidence.credibility.step.size();
                       return {short_cell(at(evidence.distribution.distance, k)),
                               short_cell(at(evidence.distribution.p, k)),
                               short_cell(known ? evidence.credibility.step[k].nci : std::nan("")),
                               short_cell(known ? evidence.credibility.step[k].inclination : std::nan(""))};
                   });
}

}  // namespace

Html step_tables(const Part& part) {
    Html html;
    for (const ArmReport* arm : part.arms) {
        if (arm->evidence.trials == 0) continue;
        Html tables;
        for (const GroupEvidence* group : shown_groups(arm->evidence)) tables += group_table(*arm, *group);
        for (const ChartEvidence& chart : arm->evidence.charts) tables += chart_table(*arm, chart);
        for (const NisEvidence& nis : arm->evidence.nis) tables += nis_table(*arm, nis);
        html += folded(arm->arm + ": every series by step", tables + bias_table(*arm) + distribution_table(*arm));
    }
    return html.empty() ? html : element("div", "<h3>By step</h3>\n"_html + html, "class=\"screen\""_html) + "\n"_html;
}

}  // namespace credence::page
