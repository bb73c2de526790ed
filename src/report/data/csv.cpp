// A report as CSV.

#include <credence/report.hpp>

#include <credence/text.hpp>

#include "base/nan.hpp"
#include "report/sweep.hpp"
#include "report/table.hpp"
#include "report/words.hpp"

#include <algorithm>

namespace credence {

namespace {

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
            add_moments(name, chart.step);
        }
        for (const NisEvidence& nis : arm_.evidence.nis) {
            add("nis_per_row:" + nis.part, nis.ratio, nis.ratio95);
            add_steps("nis_per_row:" + nis.part, nis.nis.ratio, nis.nis.simultaneous_band);
        }
        for (const Whiteness& lag : arm_.evidence.whiteness)
            add("whiteness:" + std::to_string(lag.lag), lag.scaled, {lag.scaled - lag.bound, lag.scaled + lag.bound});
        for (const BiasEvidence& bias : arm_.evidence.bias)
            if (bias.square.count > 0) add_moments("nees_per_dimension:" + bias.component, bias.square);
        for (const BiasEvidence& bias : arm_.evidence.bias)
            add_moments("mean_standardised_error:" + bias.component, bias.step);
        for (const DirectionOfGroup& one : arm_.consistency.directions.largest)
            add_direction("direction_largest:", one);
        for (const DirectionOfGroup& one : arm_.consistency.directions.smallest)
            add_direction("direction_smallest:", one);
        for (const DirectionOfGroup& one : arm_.consistency.directions.largest)
            add("direction_level:" + one.group, one.level);
        for (const TruthFactor& one : arm_.consistency.truth) {
            add("nees_with_truth:" + one.group, one.nees, one.nees95);
            add("error_over_P:" + one.group, nan, one.factor);
            add("deciding_sigma:" + one.group, one.deciding_sigma);
        }
        for (const TurningPoint& one : arm_.consistency.turning_points) {
            add("turning_point:" + one.where, one.vanishes);
            add("turning_point_right:" + one.where, one.right);
        }
        add_steps("direction_spectrum", arm_.consistency.directions.spectrum);
        if (const std::optional<Attribution>& found = arm_.consistency.attribution) {
            add("attribution_share:" + carrier_name(found->carrier), found->share);
            add("attribution_nees", found->nees, found->interval);
        }
        add_steps("distance_from_chi_square", arm_.evidence.distribution.distance);
        add("nci", arm_.evidence.credibility.nci);
        add("inclination", arm_.evidence.credibility.inclination);
        return text_;
    }

private:
    static constexpr Interval none{nan, nan};

    void add(const std::string& column, double mean, const Interval& interval = none, double se = nan,
             double sd = nan) {
        text_ += row_of(start_of(arm_, column, "1"),
                        {arm_.evidence.trials, mean, se, interval, nan, sd}, std::nullopt, std::nullopt, end_);
    }
    void add_moments(const std::string& column, const Moments& moments) {
        add(column, moments.mean, t_interval(moments), moments.standard_error, moments.standard_deviation);
    }
    void add_moments(const std::string& column, const std::vector<Moments>& steps) {
        for (std::size_t k = 0; k < steps.size(); ++k) add_moments(column + ":" + std::to_string(k + 1), steps[k]);
    }
    /// For NIS at a step the interval is its joint chi-square band: there is no spread of trials to take one from.
    void add_steps(const std::string& column, const std::vector<double>& values,
                   const std::vector<Interval>& intervals = {}) {
        for (std::size_t k = 0; k < values.size(); ++k)
            add(column + ":" + std::to_string(k + 1), values[k], intervals.empty() ? none : intervals[k]);
    }
    /// The ratio with its corrected interval, and a row for each component's share.
    void add_direction(const std::string& name, const DirectionOfGroup& direction) {
        add(name + direction.group, direction.ratio, direction.interval);
        for (const Loading& one : direction.loadings) add(name + direction.group + ":" + one.component, one.weight);
    }
    void add_group(const GroupEvidence& group) {
        add_moments("nees_per_dimension:" + group.name, group.run);
        if (group.without_diverged.count > 0)
            add_moments("nees_per_dimension_without_diverged:" + group.name, group.without_diverged);
        add_moments("nees_per_dimension:" + group.name, group.step);
        add("nees_rounding:" + group.name, group.rounding);
        add("rmse_ratio:" + group.name, group.accuracy.ratio, group.accuracy.ratio_ci95);
        for (const Coverage& level : group.coverage)
            add_steps("coverage_" + to_text(level.level) + ":" + group.name, level.share, level.interval);
        add_steps("variance_ratio:" + group.name, group.variance_ratio);
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
