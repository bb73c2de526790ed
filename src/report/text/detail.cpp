#include "report/text/detail.hpp"

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/words.hpp"

#include <cmath>

namespace credence {

namespace {

std::string published_text(const PublishedPlace& published) {
    if (!std::isfinite(published.percentile)) return to_text(published.value);
    return to_text(published.value) + " (" + number(published.percentile, 1) + " %)";
}

std::string figure_row(const std::string& label, const Summary& s, const std::optional<Interval>& bootstrap,
                       const std::string& last) {
    const int digits = decimals_for(half_width(s.ci95));
    return "    " + padded(label, 24, false) + padded(with_interval(s.mean, s.ci95), 22) +
           padded(bootstrap ? bracketed(*bootstrap, digits) : "", 22) + padded(number(s.median, digits), 12) +
           padded(number(s.standard_deviation, digits), 12) + (last.empty() ? "" : padded(last, 20)) + "\n";
}

std::string paired_row(const Comparison& pair, const ComparedColumn& column) {
    const PairedComparison& paired = column.paired;
    if (paired.pairs == 0) return {};
    const std::string less = number(100 * paired.wins_a, 0) + " % below";
    return figure_row(controller_of(pair.a) + " - " + controller_of(pair.b), paired.difference, paired.bootstrap95, less);
}

/// A part with the arms and their differences, one row each.
std::string figure_part(const Report& report, const std::string& scenario, const std::string& name) {
    std::string text;
    for (const ArmReport& arm : report.arms) {
        if (arm.scenario != scenario) continue;
        const ColumnReport& column = column_named(arm.columns, name);
        if (column.summary.count == 0) continue;
        if (text.empty()) text = "  " + figure_title(name, column.unit) + "\n";
        text += figure_row(arm.arm, column.summary, column.bootstrap95,
                           column.published ? published_text(*column.published) : "");
    }
    for (const Comparison& pair : report.pairs) {
        if (pair.scenario != scenario) continue;
        for (const ComparedColumn& column : pair.columns)
            if (column.name == name) text += paired_row(pair, column);
    }
    return text;
}

std::string block_row(const GroupEvidence& block) {
    const Coverage& coverage = block.coverage[2];
    return "    " + padded(block.block, 14, false) + padded(with_interval(block.run.mean, over_steps95(block)), 20) +
           padded(of_steps(block.anees.outside_simultaneous, block.anees.observed), 12) +
           padded(number(100 * coverage.over_steps, 1) + " %", 12) +
           padded(number(mean_of(block.variance_ratio), 2), 12) +
           padded(with_interval(block.accuracy.ratio, block.accuracy.ratio_ci95), 20) + "\n";
}

/// NEES in other charts, after the groups' own.
std::string charts_part(const Evidence& evidence) {
    if (evidence.charts.empty()) return "";
    std::vector<std::string> parts;
    for (const ChartEvidence& chart : evidence.charts)
        parts.push_back(chart.block + " " + with_interval(chart.run.mean, t_interval(chart.run)));
    return "    " + wrapped_list("NEES/dim in the " + evidence.charts.front().chart + " chart, not judged:", parts, 4) + "\n";
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
    return text + "    " + wrapped("innovations: correlation " + number(first.scaled, 4) + " at lag " + std::to_string(first.lag) +
                                       " (white within ± " + number(first.bound, 4) + "); " +
                                       of_steps(outside, static_cast<int>(evidence.whiteness.size())) +
                                       " lags outside their joint bounds", 4) + "\n";
}

std::string distribution_part(const Evidence& evidence) {
    std::string text;
    if (const WorstDistribution worst = worst_distribution(evidence.shape); worst.known > 0)
        text += "    NEES against chi-square: distance " + number(worst.distance, 4) + " at step " +
                std::to_string(worst.step) + " (p " + (worst.p < 1e-4 ? "< 0.0001" : number(worst.p, 4)) + " over all " +
                std::to_string(worst.known) + " steps)\n";
    if (std::isfinite(evidence.credibility.nci) && std::isfinite(evidence.credibility.inclination))
        text += "    NCI " + number(evidence.credibility.nci, 3) + ", I² " +
                number(evidence.credibility.inclination, 3) +
                (evidence.credibility.inclination > 0 ? " (> 0: optimistic)\n" : " (< 0: pessimistic)\n");
    return text;
}

std::string consistency_part(const ArmReport& arm) {
    if (arm.evidence.blocks.empty() || arm.evidence.trials == 0) return "";
    std::string text = "  " + padded(arm.arm, 16, false) + padded("NEES/dim", 20) + padded("steps out", 12) +
                       padded("95 % covers", 12) + padded("var/2dim", 12) + padded("RMSE/sigma", 20) + "\n";
    const auto blocks = shown_blocks(arm.evidence);
    for (const GroupEvidence* block : blocks) text += block_row(*block);
    if (blocks.size() < arm.evidence.blocks.size())
        text += "    (" + std::to_string(arm.evidence.blocks.size() - blocks.size()) +
                " more blocks are nearer to 1; JSON has all)\n";
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
std::vector<std::string> detailed_figures(const Report& report, const std::string& scenario) {
    std::vector<std::string> names{"trace_P", "mean_trace_P"};
    for (const ArmReport& arm : report.arms)
        for (const ColumnReport& column : arm.columns)
            if (arm.scenario == scenario && column.name != "nees_ratio" && column.name != "nis_ratio" &&
                std::find(names.begin(), names.end(), column.name) == names.end())
                names.push_back(column.name);
    return names;
}

}  // namespace

std::string scenario_detail(const Report& report, const Scenario& scenario) {
    std::string text = "\n" + wrapped(scenario.name + (scenario.title.empty() ? "" : ": " + scenario.title)) + "\n";
    if (!has_run(report, scenario.name)) return text + "  not run yet\n";
    text += padded("mean ± 95 %", 50) + padded("bootstrap 95 %", 22) + padded("median", 12) + padded("sd", 12) +
            (has_published(report, scenario.name) ? padded("published (pctl.)", 20) : "") + "\n";
    for (const std::string& name : detailed_figures(report, scenario.name))
        text += figure_part(report, scenario.name, name);
    for (const ArmReport& arm : report.arms)
        if (arm.scenario == scenario.name) text += consistency_part(arm);
    return text;
}

}  // namespace credence
