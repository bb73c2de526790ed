// A report as JSON.

#include <credence/report.hpp>

#include <credence/text.hpp>

#include "base/nan.hpp"
#include "report/data/json.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

namespace credence {

namespace {

Json summary_json(const Summary& summary) {
    return {{"mean", summary.mean},     {"se", summary.standard_error},     {"ci95", interval_json(summary.ci95)},
            {"median", summary.median}, {"sd", summary.standard_deviation}, {"n", summary.count}};
}

Json figure_json(const ColumnReport& column) {
    Json json = summary_json(column.summary);
    json["unit"] = column.unit;
    for (std::size_t q = 0; q < column.quantiles.size(); ++q)
        json["quantiles"][to_text(reported_quantiles[q])] = column.quantiles[q];
    if (column.bootstrap95) json["bootstrap95"] = interval_json(*column.bootstrap95);
    if (column.published)
        json["published"] = {{"value", column.published->value}, {"percentile", column.published->percentile}};
    return json;
}

Json cause_json(const FailureCause& cause) {
    Json json{{"status", status_names()[static_cast<std::size_t>(cause.status)]}, {"trials", cause.trials}};
    if (cause.at_pose > 0) json.update({{cause.place, cause.pose}, {"trials_there", cause.at_pose}});
    return json;
}

Json gaps_json(const RecordGaps& gaps) {
    return {{"steps", gaps.steps},
            {"missing", gaps.missing},
            {"share", static_cast<double>(gaps.missing) / static_cast<double>(gaps.steps)},
            {"trials", gaps.runs},
            {"worst_trial", {{"trial", gaps.trial}, {"missing", gaps.of_trial}}},
            {"by_step", gaps.by_step},
            {"nees_ratio_beside", gaps.beside},
            {"nees_ratio_elsewhere", gaps.elsewhere}};
}

Json finding_json(const Finding& finding) {
    return {{"what", fault_name(finding.what)},
            {"about", subject_name(finding.about)},
            {"where", finding.where},
            {"when", when_text(finding)},
            {"measure", finding.measure},
            {"value", finding.value},
            {"interval", interval_json(finding.interval)},
            {"text", sentence(finding)}};
}

Json suspicion_json(const Suspicion& one) {
    return {{"what", fault_name(one.what)},
            {"about", subject_name(one.about)},
            {"where", one.where},
            {"measure", one.measure},
            {"value", one.value},
            {"trials", one.trials.value},
            {"trials_range", {one.trials.low, one.trials.high}}};
}

Json direction_json(const DirectionOfGroup& one) {
    Json loadings = Json::object();
    for (const Loading& loading : one.loadings) loadings[loading.component] = loading.weight;
    return {{"group", one.group}, {"direction", one.name},
            {"ratio", one.ratio}, {"interval", interval_json(one.interval)},
            {"level", one.level}, {"loadings", loadings}};
}

Json directions_json(const DirectionsFound& directions) {
    if (!directions.unknown.empty()) return {{"unknown", directions.unknown}};
    if (directions.spectrum.empty()) return nullptr;
    return {{"trials", directions.trials},
            {"range95", interval_json(directions.range)},
            {"spectrum", directions.spectrum},
            {"largest", each_json(directions.largest, direction_json)},
            {"smallest", each_json(directions.smallest, direction_json)}};
}

Json truth_json(const TruthFactor& one) {
    return {{"group", one.group},
            {"nees_ratio", one.nees},
            {"ci95", interval_json(one.nees95)},
            {"factor95", interval_json(one.factor)},
            {"deciding_sigma", one.deciding_sigma}};
}

Json turning_point_json(const TurningPoint& one) {
    return {{"where", one.where}, {"unit", one.unit}, {"vanishes", one.vanishes}, {"right", one.right}};
}

Json worst_trial_json(const WorstTrial& one) {
    return {{"trial", one.trial}, {"nees_ratio", one.nees_ratio}, {"step", one.step}};
}

Json arm_json(const Report& report, const ArmReport& arm) {
    const Consistency& verdict = arm.consistency;
    Json head{{"scenario", arm.scenario},
              {"arm", arm.arm},
              {"trials", arm.trials},
              {"failed", arm.failed},
              {"diverged", arm.diverged},
              {"failed_trials", arm.failed_trials()},
              {"may_be_unseen", arm.evidence.may_be_unseen()}};
    if (arm.gaps.missing > 0) head["missing_steps"] = gaps_json(arm.gaps);
    if (arm.cause) head["failed_most"] = cause_json(*arm.cause);
    for (const Scenario& scenario : report.scenarios)
        if (scenario.name == arm.scenario && is_swept(scenario)) head["sweep"] = sweep_json(scenario.sweep);
    Json json;
    json["verdict"] = verdict_name(verdict.verdict);
    if (const std::string reason = no_claim_text(arm); !reason.empty()) json["reason"] = reason;
    json["margin"] = verdict.limits.margin;
    json["failed_limit"] = verdict.limits.failed;
    json["margin_direction"] = verdict.limits.direction;
    json["bias_limit"] = verdict.limits.bias;
    if (const TrialsNeeded& needed = verdict.trials_needed; needed.value > 0) {
        json["trials_to_decide"] = needed.value;
        json["trials_to_decide_range"] = {needed.low, needed.high};
    }
    const SegmentEvidence& segments = arm.evidence.segments;
    json["evidence"] = arm.evidence.units();
    if (arm.every > 1) json["every"] = arm.every;
    if (segments.steps > 0)
        json["segments"] = {
            {"count", std::ssize(segments.run)},
            {"steps", segments.steps},
            {"autocorrelation_time", segments.autocorrelation_time > 0 ? Json(segments.autocorrelation_time) : Json()}};
    const Reached& reached = verdict.reached;
    const Interval& faults = verdict.smallest_faults;
    json["smallest_faults"] = {{"low", faults.low}, {"high", faults.high}};
    json["reached"] = {{"nees", reached.nees}, {"direction", reached.direction}, {"bias", reached.bias}};
    json["p_exact"] = arm.evidence.groups.empty() ? nan : t_test(arm.evidence.groups.front().run, 1);
    json["directions"] = directions_json(verdict.directions);
    json["hints"] = verdict.hints;
    json["mix_up"] = verdict.mix_up;
    const std::optional<Attribution>& found = verdict.attribution;
    json["attribution"] = found ? Json{{"carrier", carrier_name(found->carrier)},
                                       {"share", found->share},
                                       {"nees_per_dimension", found->nees},
                                       {"ci95", {found->interval.low, found->interval.high}}}
                                : Json();
    json["worst_trials"] = {{"share", arm.evidence.worst.share},
                            {"trials", each_json(arm.evidence.worst.trials, worst_trial_json)}};
    json["suspicions"] = each_json(verdict.suspicions, suspicion_json);
    if (!verdict.truth.empty()) json["truth"] = each_json(verdict.truth, truth_json);
    if (!verdict.turning_points.empty()) json["turning_points"] = each_json(verdict.turning_points, turning_point_json);
    json["findings"] = each_json(verdict.findings, finding_json);
    json["cautions"] = each_json(verdict.cautions, finding_json);
    json.update(evidence_json(arm.evidence));
    for (const Comparison& pair : report.pairs)
        if (pair.scenario == arm.scenario && pair.a == arm.arm)
            add_columns(json["paired_difference"] = {{"pair", pair.name()}}, pair.columns, compared_json,
                        Json::object());
    for (const RecordTrouble& trouble : report.troubles)
        json["troubles"].push_back({{"trial", trouble.trial}, {"step", trouble.step}, {"what", trouble.what}});
    if (!report.not_judged.empty()) json["not_judged"] = report.not_judged;
    json["source"] = report.source;
    json["root_seed"] = report.root_seed ? Json(*report.root_seed) : Json();
    json["complete"] = report.complete;
    add_columns(head, arm.columns, figure_json, json);
    return head;
}

}  // namespace

std::string report_json(const Report& report) {
    Json array = Json::array();
    for (const ArmReport& arm : report.arms) array.push_back(arm_json(report, arm));
    return array.dump(2) + "\n";
}

}  // namespace credence
