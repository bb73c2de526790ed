#include "report/data/json.hpp"

#include <credence/consistency.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

Json intervals_json(const std::vector<Interval>& intervals) { return each_json(intervals, interval_json); }

Json banded_json(const BandedRatio& ratio) {
    return {{"degrees", ratio.degrees},
            {"ratio", ratio.ratio},
            {"band95", intervals_json(ratio.band)},
            {"simultaneous_band95", intervals_json(ratio.simultaneous_band)},
            {"steps", ratio.observed},
            {"steps_outside", ratio.outside},
            {"steps_outside_simultaneous", ratio.outside_simultaneous}};
}

Json coverage_json(const Coverage& coverage) {
    return {{"level", coverage.level},
            {"mean", coverage.over_steps},
            {"share", coverage.share},
            {"ci95", intervals_json(coverage.interval)}};
}

Json accuracy_json(const Accuracy& accuracy) {
    return {{"unit_of_square", accuracy.unit},       {"rmse", accuracy.over_steps}, {"rmse_ratio", accuracy.ratio},
            {"rmse_ratio_ci95", interval_json(accuracy.ratio_ci95)},
            {"rmse_by_step", accuracy.rmse},         {"predicted_by_step", accuracy.predicted}};
}

/// The members for a group's NEES in any chart.
template <class Ratios>
Json ratios_json(const Ratios& of) {
    return {{"group", of.name},
            {"dimension", of.dimension},
            {"nees_ratio", of.run.mean},
            {"se", of.run.standard_error},
            {"ci95", interval_json(t_interval(of.run))},
            {"anees", banded_json(of.anees)},
            {"anees_se", each_json(of.step, [](const Moments& step) { return step.standard_error; })}};
}

Json group_json(const GroupEvidence& group) {
    Json json = ratios_json(group);
    if (group.without_diverged.count > 0)
        json["without_diverged"] = {{"nees_ratio", group.without_diverged.mean},
                                    {"se", group.without_diverged.standard_error},
                                    {"ci95", interval_json(t_interval(group.without_diverged))}};
    json["rounding"] = group.rounding;
    json["variance_ratio"] = group.variance_ratio;
    json["coverage"] = each_json(group.coverage, coverage_json);
    json["accuracy"] = accuracy_json(group.accuracy);
    return json;
}

Json chart_json(const ChartEvidence& chart) {
    Json json = ratios_json(chart);
    json["chart"] = chart.chart;
    return json;
}

Json nis_json(const NisEvidence& nis) {
    return {{"rows", nis.part},
            {"degrees", nis.degrees},
            {"ratio", nis.ratio},
            {"ratio_ci95", interval_json(nis.ratio95)},
            {"scale95", interval_json(nis.scale95)},
            {"by_step", banded_json(nis.nis)}};
}

Json whiteness_json(const Whiteness& lag) {
    return {{"lag", lag.lag},     {"correlation", lag.correlation}, {"scaled", lag.scaled},
            {"count", lag.count}, {"bound95", lag.bound},           {"simultaneous_bound95", lag.simultaneous_bound}};
}

Json bias_json(const BiasEvidence& bias) {
    return {{"component", bias.component},
            {"mean", each_json(bias.step, [](const Moments& step) { return step.mean; })},
            {"se", each_json(bias.step, [](const Moments& step) { return step.standard_error; })}};
}

Json credibility_json(const CredibilityEvidence& evidence) {
    std::int64_t trials = 0;
    for (const Credibility& step : evidence.step) trials = std::max(trials, step.count);
    return {
        {"trials", trials},
        {"nci", evidence.nci},
        {"inclination", evidence.inclination},
        {"nci_by_step", each_json(evidence.step, [](const Credibility& step) { return step.nci; })},
        {"inclination_by_step", each_json(evidence.step, [](const Credibility& step) { return step.inclination; })}};
}

}  // namespace

Json evidence_json(const Evidence& evidence) {
    Json json{{"groups", each_json(evidence.groups, group_json)},
              {"nis", each_json(evidence.nis, nis_json)},
              {"whiteness", each_json(evidence.whiteness, whiteness_json)},
              {"bias", each_json(evidence.bias, bias_json)},
              {"distribution",
               {{"exact", evidence.distribution.exact},
                {"distance", evidence.distribution.distance},
                {"p", evidence.distribution.p}}},
              {"credibility", credibility_json(evidence.credibility)}};
    if (!evidence.charts.empty()) json["other_charts"] = each_json(evidence.charts, chart_json);
    return json;
}

Json sweep_json(const SweepPoint& sweep) {
    Json at;
    for (const SweepCoordinate& one : sweep.at) {
        const std::optional<double> number = to_number(one.value);
        at[one.key] = number && std::isfinite(*number) ? Json(*number) : Json(one.value);
    }
    return {{"of", sweep.of}, {"at", at}};
}

Json compared_json(const ComparedColumn& column) {
    const PairedComparison& paired = column.paired;
    const Summary& difference = paired.difference;
    return {{"mean", difference.mean},
            {"se", difference.standard_error},
            {"ci95", interval_json(difference.ci95)},
            {"bootstrap95", interval_json(paired.bootstrap95)},
            {"median", difference.median},
            {"sd", difference.standard_deviation},
            {"n", paired.pairs},
            {"unit", column.unit},
            {"below", paired.wins_a},
            {"above", paired.wins_b},
            {"ties", paired.ties},
            {"wilcoxon_z", paired.wilcoxon_z},
            {"wilcoxon_p", paired.wilcoxon_p},
            {"holm_p", column.holm_p},
            {"effect_size", paired.effect_size},
            {"variance_reduction", paired.variance_reduction}};
}

}  // namespace credence
