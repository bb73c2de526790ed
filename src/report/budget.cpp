#include "report/budget.hpp"

#include "base/formatted.hpp"
#include "report/data/json.hpp"
#include "report/table.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

const BudgetPart& part_of(const ArmBudget& arm, const std::string& name) {
    return name.empty() ? arm.parts.front() : *std::ranges::find(arm.parts, name, &BudgetPart::name);
}

std::string name_with_unit(const BudgetPart& part) {
    return part.unit.empty() || part.unit == "1" ? part.name : part.name + " [" + part.unit + "]";
}

std::string arm_sentence(const ArmBudget& arm) {
    std::string text = arm.at == KeptErrors::last ? "at the last step" : "on average over the steps";
    text += ", by its sources: " + std::to_string(arm.trials) + " trials" +
            (arm.scenario.empty() ? "" : " of " + arm.scenario + "/" + arm.arm);
    if (arm.left_out > 0)
        text += "; " + std::to_string(arm.left_out) + " more that failed or diverged in a run are left out";
    return text;
}

namespace {

std::string part_text(const BudgetPart& part, bool counts) {
    std::size_t width = 10;
    for (const Contribution& one : part.contributions) width = std::max(width, one.source.size());
    const int w = static_cast<int>(width);
    std::string text = formatted("  %-*s     alone  95 %%                    share  with others", w, "source");
    text += counts ? "  P counts  error²/P's\n" : "\n";
    for (const Contribution& one : part.contributions) {
        const std::string alone = std::isnan(one.alone) ? formatted("< %.3g", one.alone95.high)
                                                        : formatted("%.4g", one.alone);
        const std::string share = std::isnan(one.share) ? "-" : formatted("%.1f %%", 100 * one.share);
        const std::string interval = formatted("%.4g to %.4g", one.alone95.low, one.alone95.high);
        text += formatted("  %-*s %9s  %-22s %8s  ", w, one.source.c_str(), alone.c_str(), interval.c_str(),
                          share.c_str());
        if (!counts) {
            text += formatted("%.4g\n", one.with_others);
            continue;
        }
        const std::string ratio = std::isnan(one.ratio) ? "-" : formatted("%.0f %%", 100 * one.ratio);
        text += formatted("%11.4g  %8.4g  %10s\n", one.with_others, one.p_counts, ratio.c_str());
    }
    text += formatted("  %-*s %9.4g\n", w, "mean error", part.mean);
    text += formatted("  interactions at most %.4g; together %.4g, RMSE %.4g", part.interactions, part.rss, part.rmse);
    text += part.closes ? "\n" : ": they do not meet, as three sources or more interact\n";
    if (!std::isnan(part.p_says))
        text += formatted("  P says %.4g: the squared error is %.0f %% of it\n", part.p_says, 100 * part.ratio);
    if (part.there < 1)
        text += formatted("  %.3g %% of its errors are left out: in some run it was not in the state\n",
                          100 * (1 - part.there));
    return text;
}

Json part_json(const BudgetPart& part) {
    Json sources = Json::array();
    for (const Contribution& one : part.contributions)
        sources.push_back({{"source", one.source},
                           {"alone", one.alone},
                           {"alone_ci", interval_json(one.alone95)},
                           {"share", one.share},
                           {"with_others", one.with_others},
                           {"p_counts", one.p_counts},
                           {"ratio", one.ratio}});
    return {{"of", part.name},
            {"unit", part.unit},
            {"sources", std::move(sources)},
            {"mean", part.mean},
            {"interactions", part.interactions},
            {"rss", part.rss},
            {"rmse", part.rmse},
            {"closes", part.closes},
            {"p_says", part.p_says},
            {"ratio", part.ratio},
            {"there", part.there}};
}

std::string budget_text(const BudgetReport& report) {
    std::string text;
    for (const ArmBudget& arm : report.arms) {
        const BudgetPart& part = part_of(arm, report.of);
        text += (text.empty() ? "error of " : "\nerror of ") + name_with_unit(part) + " " + arm_sentence(arm) + "\n" +
                part_text(part, arm.counted_trials > 0);
    }
    return text;
}

std::string budget_json(const BudgetReport& report) {
    Json array = Json::array();
    for (const ArmBudget& arm : report.arms) {
        Json parts = Json::array();
        for (const BudgetPart& part : arm.parts) parts.push_back(part_json(part));
        array.push_back({{"scenario", arm.scenario},
                         {"arm", arm.arm},
                         {"trials", arm.trials},
                         {"left_out", arm.left_out},
                         {"counted_trials", arm.counted_trials},
                         {"root_seed", report.root_seed},
                         {"sources", arm.sources},
                         {"at", kept_errors_names()[static_cast<std::size_t>(arm.at)]},
                         {"of", part_of(arm, report.of).name},
                         {"parts", std::move(parts)}});
    }
    return array.dump(2) + "\n";
}

std::string budget_csv(const BudgetReport& report) {
    std::string text = csv_row({"scenario", "arm", "of", "unit", "source", "alone", "alone_low", "alone_high", "share",
                                "with_others", "p_counts", "ratio"});
    for (const ArmBudget& arm : report.arms)
        for (const BudgetPart& part : arm.parts)
            for (const Contribution& one : part.contributions) {
                std::vector<Cell> cells{arm.scenario, arm.arm, part.name, part.unit, one.source};
                for (const double value : {one.alone, one.alone95.low, one.alone95.high, one.share, one.with_others,
                                           one.p_counts, one.ratio})
                    cells.push_back(exact_cell(value));
                text += csv_row(cells);
            }
    return text;
}

}  // namespace

std::string budget_in(const BudgetReport& report, const std::string& format) {
    return format == "json" ? budget_json(report) : format == "csv" ? budget_csv(report) : budget_text(report);
}

}  // namespace credence
