// The report for programs: JSON and CSV.

#include <credence/report.hpp>

#include <credence/text.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

namespace credence {

namespace {

using Json = nlohmann::ordered_json;

Json interval_json(const Interval& interval) { return Json::array({interval.low, interval.high}); }

Json figure_json(const FigureReport& figure) {
    Json json{{"mean", figure.summary.mean},
              {"se", figure.summary.standard_error},
              {"ci95", interval_json(figure.summary.ci95)},
              {"median", figure.summary.median},
              {"sd", figure.summary.standard_deviation},
              {"n", figure.summary.count},
              {"unit", figure.unit}};
    if (figure.published)
        json["published"] = {{"value", figure.published->value}, {"percentile", figure.published->percentile}};
    return json;
}

Json consistency_json(const Consistency& consistency) {
    Json blocks = Json::array(), findings = Json::array();
    for (const BlockConsistency& block : consistency.blocks)
        blocks.push_back({{"block", block.block}, {"dimension", block.dimension}, {"nees_ratio", block.ratio},
                          {"se", block.standard_error}, {"ci95", interval_json(block.ci95)}});
    for (const Finding& finding : consistency.findings)
        findings.push_back({{"what", finding.what}, {"where", finding.where}, {"when", finding.when},
                            {"value", finding.value}, {"interval", interval_json(finding.interval)},
                            {"text", sentence(finding)}});
    return {{"blocks", blocks}, {"findings", findings}};
}

Json arm_json(const Report& report, const ArmReport& arm) {
    Json json{{"scenario", arm.scenario}, {"arm", arm.arm}, {"trials", arm.trials}, {"failed", arm.failed},
              {"diverged", arm.diverged}};
    for (const FigureReport& figure : arm.figures) json[figure.name] = figure_json(figure);
    json["verdict"] = verdict_name(arm.consistency.verdict);
    json["margin"] = arm.consistency.margin;
    if (arm.consistency.trials_to_decide > 0) json["trials_to_decide"] = arm.consistency.trials_to_decide;
    json.update(consistency_json(arm.consistency));
    for (const PairReport& pair : report.pairs) {
        if (pair.scenario != arm.scenario || !pair.name.starts_with(arm.arm + " - ")) continue;
        Json differences{{"pair", pair.name}};
        for (const FigureReport& figure : pair.figures) differences[figure.name] = figure_json(figure);
        json["paired_difference"] = differences;
    }
    json["study"] = report.study_hash;
    json["root_seed"] = report.root_seed;
    json["complete"] = report.complete;
    return json;
}

std::string csv_row(const std::string& scenario, const std::string& arm, const std::string& trials,
                    const std::string& failed, const FigureReport& figure, const std::string& verdict) {
    const Summary& s = figure.summary;
    std::vector<std::string> cells{scenario, arm, trials, failed, figure.name, figure.unit};
    for (const double value : {s.mean, s.standard_error, s.ci95.low, s.ci95.high, s.median, s.standard_deviation})
        cells.push_back(std::isnan(value) ? "" : to_text(value));
    cells.push_back(figure.published ? to_text(figure.published->value) : "");
    cells.push_back(figure.published ? to_text(figure.published->percentile) : "");
    cells.push_back(verdict);
    return joined(cells, ",") + "\n";
}

}  // namespace

std::string report_json(const Report& report) {
    Json array = Json::array();
    for (const ArmReport& arm : report.arms) array.push_back(arm_json(report, arm));
    return array.dump(2) + "\n";
}

std::string report_csv(const Report& report) {
    std::string text =
        "scenario,arm,trials,failed,figure,unit,mean,se,ci95_low,ci95_high,median,sd,published,percentile,verdict\n";
    for (const ArmReport& arm : report.arms)
        for (const FigureReport& figure : arm.figures)
            text += csv_row(arm.scenario, arm.arm, std::to_string(arm.trials), std::to_string(arm.failed), figure,
                            verdict_name(arm.consistency.verdict));
    for (const PairReport& pair : report.pairs)
        for (const FigureReport& figure : pair.figures)
            text += csv_row(pair.scenario, pair.name, std::to_string(figure.summary.count), "", figure, "");
    return text;
}

}  // namespace credence
