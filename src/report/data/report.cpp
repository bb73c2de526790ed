// Machine-readable output of a report: JSON and CSV.

#include <credence/report.hpp>

#include <credence/text.hpp>

#include "base/nan.hpp"
#include "report/data/json.hpp"
#include "report/sweep.hpp"
#include "report/table.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

Json summary_json(const Summary& summary) {
    return {{"mean", summary.mean},
            {"se", summary.standard_error},
            {"ci95", interval_json(summary.ci95)},
            {"median", summary.median},
            {"sd", summary.standard_deviation},
            {"n", summary.count}};
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

Json findings_json(const std::vector<Finding>& findings) {
    Json json = Json::array();
    for (const Finding& finding : findings)
        json.push_back({{"what", fault_name(finding.what)},
                        {"about", subject_name(finding.about)},
                        {"where", finding.where},
                        {"when", when_text(finding)},
                        {"measure", finding.measure},
                        {"value", finding.value},
                        {"interval", interval_json(finding.interval)},
                        {"text", sentence(finding)}});
    return json;
}

Json suspicions_json(const std::vector<Suspicion>& suspicions) {
    Json json = Json::array();
    for (const Suspicion& one : suspicions)
        json.push_back({{"what", fault_name(one.what)},
                        {"about", subject_name(one.about)},
                        {"where", one.where},
                        {"measure", one.measure},
                        {"value", one.value},
                        {"trials", one.trials.value},
                        {"trials_range", {one.trials.low, one.trials.high}}});
    return json;
}

Json loadings_json(const std::vector<Loading>& loadings) {
    Json json = Json::object();
    for (const Loading& one : loadings) json[one.component] = one.weight;
    return json;
}

Json directions_json(const DirectionsFound& directions) {
    if (!directions.unknown.empty()) return {{"unknown", directions.unknown}};
    if (directions.spectrum.empty()) return nullptr;
    const auto list = [](const std::vector<DirectionOfGroup>& all) {
        Json json = Json::array();
        for (const DirectionOfGroup& one : all)
            json.push_back({{"group", one.group},
                            {"direction", one.name},
                            {"ratio", one.ratio},
                            {"interval", interval_json(one.interval)},
                            {"level", one.level},
                            {"loadings", loadings_json(one.loadings)}});
        return json;
    };
    return {{"trials", directions.trials},
            {"range95", interval_json(directions.range)},
            {"spectrum", directions.spectrum},
            {"largest", list(directions.largest)},
            {"smallest", list(directions.smallest)}};
}

Json truth_json(const Consistency& verdict) {
    Json json = Json::array();
    for (const TruthFactor& one : verdict.truth)
        json.push_back({{"group", one.group},
                        {"nees_ratio", one.nees},
                        {"ci95", interval_json(one.nees95)},
                        {"factor95", interval_json(one.factor)},
                        {"deciding_sigma", one.deciding_sigma}});
    return json;
}

Json turning_points_json(const Consistency& verdict) {
    Json json = Json::array();
    for (const TurningPoint& one : verdict.turning_points)
        json.push_back({{"where", one.where}, {"unit", one.unit}, {"vanishes", one.vanishes}, {"right", one.right}});
    return json;
}

Json arm_json(const Report& report, const ArmReport& arm) {
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
    json["verdict"] = verdict_name(arm.consistency.verdict);
    if (const std::string reason = no_claim_text(arm); !reason.empty()) json["reason"] = reason;
    json["margin"] = arm.consistency.limits.margin;
    json["failed_limit"] = arm.consistency.limits.failed;
    json["margin_direction"] = arm.consistency.limits.direction;
    json["bias_limit"] = arm.consistency.limits.bias;
    if (const TrialsNeeded& needed = arm.consistency.trials_needed; needed.value > 0) {
        json["trials_to_decide"] = needed.value;
        json["trials_to_decide_range"] = {needed.low, needed.high};
    }
    const SegmentEvidence& segments = arm.evidence.segments;
    json["evidence"] = arm.evidence.units();
    if (arm.every > 1) json["every"] = arm.every;
    if (segments.steps > 0)
        json["segments"] = {{"count", std::ssize(segments.run)},
                            {"steps", segments.steps},
                            {"autocorrelation_time", segments.autocorrelation_time > 0
                                                         ? Json(segments.autocorrelation_time)
                                                         : Json()}};
    const Reached& reached = arm.consistency.reached;
    const Interval& faults = arm.consistency.smallest_faults;
    json["smallest_faults"] = {{"low", faults.low}, {"high", faults.high}};
    json["reached"] = {{"nees", reached.nees}, {"direction", reached.direction}, {"bias", reached.bias}};
    json["p_exact"] = arm.evidence.groups.empty() ? nan : t_test(arm.evidence.groups.front().run, 1);
    json["directions"] = directions_json(arm.consistency.directions);
    json["hints"] = arm.consistency.hints;
    json["mix_up"] = arm.consistency.mix_up;
    const std::optional<Attribution>& found = arm.consistency.attribution;
    json["attribution"] = found ? Json{{"carrier", carrier_name(found->carrier)},
                                       {"share", found->share},
                                       {"nees_per_dimension", found->nees},
                                       {"ci95", {found->interval.low, found->interval.high}}}
                                : Json();
    json["worst_trials"] = {{"share", arm.evidence.worst.share}, {"trials", Json::array()}};
    for (const WorstTrial& one : arm.evidence.worst.trials)
        json["worst_trials"]["trials"].push_back(
            {{"trial", one.trial}, {"nees_ratio", one.nees_ratio}, {"step", one.step}});
    json["suspicions"] = suspicions_json(arm.consistency.suspicions);
    if (!arm.consistency.truth.empty()) json["truth"] = truth_json(arm.consistency);
    if (!arm.consistency.turning_points.empty()) json["turning_points"] = turning_points_json(arm.consistency);
    json["findings"] = findings_json(arm.consistency.findings);
    json["cautions"] = findings_json(arm.consistency.cautions);
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

using Cells = std::vector<Cell>;

Cells operator+(Cells a, const Cells& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// One row, with `end` after its numbers.
std::string row_of(Cells cells, const Summary& s, const std::optional<Interval>& bootstrap,
                   const std::optional<PublishedPlace>& published, const Cells& end) {
    const Interval resampled = bootstrap.value_or(Interval{nan, nan});
    const PublishedPlace place = published.value_or(PublishedPlace{nan, nan});
    for (const double value : {s.mean, s.standard_error, s.ci95.low, s.ci95.high, resampled.low, resampled.high,
                               s.median, s.standard_deviation, place.value, place.percentile})
        cells.push_back(exact_cell(value));
    return csv_row(std::move(cells) + end);
}

Cells start_of(const ArmReport& arm, const std::string& name, const std::string& unit) {
    return {arm.scenario, arm.arm, std::to_string(arm.trials), std::to_string(arm.failed), name, unit};
}

/// Rows of an arm's evidence. The group or part is appended to the name after a colon, the step after a second one.
class EvidenceRows {
public:
    EvidenceRows(const ArmReport& arm, const Cells& end) : arm_(arm), end_(end) {}

    std::string text() {
        for (const GroupEvidence& group : arm_.evidence.groups) add_group(group);
        for (const ChartEvidence& chart : arm_.evidence.charts) {
            const std::string name = "nees_per_dimension_" + chart.chart + ":" + chart.name;
            add_moments(name, chart.run);
            for (std::size_t k = 0; k < chart.step.size(); ++k)
                add_moments(name + ":" + std::to_string(k + 1), chart.step[k]);
        }
        for (const NisEvidence& nis : arm_.evidence.nis) {
            add("nis_per_row:" + nis.part, nis.ratio, nan, nis.ratio95);
            add_steps("nis_per_row:" + nis.part, nis.nis.ratio, nis.nis.simultaneous_band);
        }
        for (const Whiteness& lag : arm_.evidence.whiteness)
            add("whiteness:" + std::to_string(lag.lag), lag.scaled, nan,
                {lag.scaled - lag.bound, lag.scaled + lag.bound});
        for (const BiasEvidence& bias : arm_.evidence.bias)
            if (bias.square.count > 0) add_moments("nees_per_dimension:" + bias.component, bias.square);
        for (const BiasEvidence& bias : arm_.evidence.bias)
            for (std::size_t k = 0; k < bias.step.size(); ++k)
                add_moments("mean_standardised_error:" + bias.component + ":" + std::to_string(k + 1), bias.step[k]);
        for (const DirectionOfGroup& one : arm_.consistency.directions.largest)
            add_direction("direction_largest:", one);
        for (const DirectionOfGroup& one : arm_.consistency.directions.smallest)
            add_direction("direction_smallest:", one);
        for (const DirectionOfGroup& one : arm_.consistency.directions.largest)
            add("direction_level:" + one.group, one.level, nan, none);
        for (const TruthFactor& one : arm_.consistency.truth) {
            add("nees_with_truth:" + one.group, one.nees, nan, one.nees95);
            add("error_over_P:" + one.group, nan, nan, one.factor);
            add("deciding_sigma:" + one.group, one.deciding_sigma, nan, none);
        }
        for (const TurningPoint& one : arm_.consistency.turning_points) {
            add("turning_point:" + one.where, one.vanishes, nan, none);
            add("turning_point_right:" + one.where, one.right, nan, none);
        }
        add_steps("direction_spectrum", arm_.consistency.directions.spectrum, {});
        if (const std::optional<Attribution>& found = arm_.consistency.attribution) {
            add("attribution_share:" + carrier_name(found->carrier), found->share, nan, none);
            add("attribution_nees", found->nees, nan, found->interval);
        }
        add_steps("distance_from_chi_square", arm_.evidence.distribution.distance, {});
        add("nci", arm_.evidence.credibility.nci, nan, none);
        add("inclination", arm_.evidence.credibility.inclination, nan, none);
        return text_;
    }

private:
    static constexpr Interval none{nan, nan};

    void add(const std::string& column, double mean, double se, const Interval& interval, double sd = nan) {
        text_ += row_of(start_of(arm_, column, "1"),
                        {arm_.evidence.trials, mean, se, interval, nan, sd}, std::nullopt, std::nullopt, end_);
    }
    void add_moments(const std::string& column, const Moments& moments) {
        add(column, moments.mean, moments.standard_error, t_interval(moments), moments.standard_deviation);
    }
    /// For NIS at a step the interval is its joint chi-square band: there is no spread of trials to take one from.
    void add_steps(const std::string& column, const std::vector<double>& values,
                   const std::vector<Interval>& intervals) {
        for (std::size_t k = 0; k < values.size(); ++k)
            add(column + ":" + std::to_string(k + 1), values[k], nan, intervals.empty() ? none : intervals[k]);
    }
    /// The ratio with its corrected interval, and a row for each component's share.
    void add_direction(const std::string& name, const DirectionOfGroup& direction) {
        add(name + direction.group, direction.ratio, nan, direction.interval);
        for (const Loading& one : direction.loadings)
            add(name + direction.group + ":" + one.component, one.weight, nan, none);
    }
    void add_group(const GroupEvidence& group) {
        add_moments("nees_per_dimension:" + group.name, group.run);
        if (group.without_diverged.count > 0)
            add_moments("nees_per_dimension_without_diverged:" + group.name, group.without_diverged);
        for (std::size_t k = 0; k < group.step.size(); ++k)
            add_moments("nees_per_dimension:" + group.name + ":" + std::to_string(k + 1), group.step[k]);
        add("nees_rounding:" + group.name, group.rounding, nan, none);
        add("rmse_ratio:" + group.name, group.accuracy.ratio, nan, group.accuracy.ratio_ci95);
        for (const Coverage& level : group.coverage)
            add_steps("coverage_" + to_text(level.level) + ":" + group.name, level.share, level.interval);
        add_steps("variance_ratio:" + group.name, group.variance_ratio, {});
    }

    const ArmReport& arm_;
    const Cells& end_;
    std::string text_;
};

/// Every swept key of a study, in the order of their first points.
std::vector<std::string> swept_keys(const Report& report) {
    std::vector<std::string> keys;
    for (const Scenario& scenario : report.scenarios)
        for (const SweepCoordinate& one : scenario.sweep.at)
            if (std::ranges::find(keys, one.key) == keys.end()) keys.push_back(one.key);
    return keys;
}

/// The swept scenario and the values of these keys; blank for a scenario without them.
Cells place_in_sweep(const Report& report, const std::string& scenario, const std::vector<std::string>& keys) {
    if (keys.empty()) return {};
    const SweepPoint place = std::ranges::find(report.scenarios, scenario, &Scenario::name)->sweep;
    Cells cells{place.of};
    for (const std::string& key : keys) {
        const auto one = std::ranges::find(place.at, key, &SweepCoordinate::key);
        cells.push_back(one == place.at.end() ? Cell() : Cell(one->value));
    }
    return cells;
}

}  // namespace

std::string report_json(const Report& report) {
    Json array = Json::array();
    for (const ArmReport& arm : report.arms) array.push_back(arm_json(report, arm));
    return array.dump(2) + "\n";
}

std::string report_csv(const Report& report) {
    const std::vector<std::string> keys = swept_keys(report);
    const Cells heads{"scenario", "arm", "trials", "failed", "name", "unit", "mean", "se", "ci95_low", "ci95_high",
                      "bootstrap95_low", "bootstrap95_high", "median", "sd", "published", "percentile", "verdict"};
    std::string text = csv_row(heads + (keys.empty() ? Cells() : Cells{"sweep_of"} + Cells(keys.begin(), keys.end())) +
                               Cells{"failed_trials"});
    for (const ArmReport& arm : report.arms) {
        const Cells end = Cells{verdict_word(arm)} + place_in_sweep(report, arm.scenario, keys) +
                          Cells{std::to_string(arm.failed_trials())};
        for (const ColumnReport& column : arm.columns)
            text += row_of(start_of(arm, column.name, column.unit), column.summary, column.bootstrap95,
                           column.published, end);
        text += EvidenceRows(arm, end).text();
    }
    for (const Comparison& pair : report.pairs) {
        const Cells end = Cells{""} + place_in_sweep(report, pair.scenario, keys) + Cells{""};
        for (const ComparedColumn& column : pair.columns)
            text +=
                row_of({pair.scenario, pair.name(), std::to_string(column.paired.pairs), "", column.name, column.unit},
                       column.paired.difference, column.paired.bootstrap95, std::nullopt, end);
    }
    return text;
}

}  // namespace credence
