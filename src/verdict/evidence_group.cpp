// The evidence of one component group: NEES, its coverage, and errors against their prediction.

#include "statistics/goodness.hpp"

#include "verdict/evidence_parts.hpp"
#include "base/nan.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

Moments scaled(Moments moments, double scale) {
    moments.mean *= scale;
    moments.standard_deviation *= scale;
    moments.standard_error *= scale;
    return moments;
}

/// The sum over the steps of one trial, over all trials.
double run_total(const SeriesTotals& totals) {
    if (totals.run_sum) return totals.run_sum->rounded();
    ExactSum sum;
    for (const ExactSum& step : totals.sum) sum.add(step);
    return sum.rounded();
}

std::vector<Coverage> coverage_of(const ArmResults& arm, const SeriesTotals& totals) {
    std::vector<Coverage> coverage;
    for (std::size_t level = 0; level < coverage_level_count; ++level) {
        Coverage one{coverage_levels[level], {}, {}, 0};
        double known = 0;
        for (std::size_t k = 0; k < totals.sum.size(); ++k) {
            const double trials = static_cast<double>(arm.totals.counted_at(totals, k)),
                         covered = static_cast<double>(totals.covered[k * coverage_level_count + level]);
            one.share.push_back(trials > 0 ? covered / trials : nan);
            one.interval.push_back(wilson_interval(covered, trials));
            if (trials == 0) continue;
            ++known;
            one.over_steps += one.share.back();
        }
        one.over_steps /= known;
        coverage.push_back(std::move(one));
    }
    return coverage;
}

const SeriesTotals* totals_of(const ScenarioResults& results, const ArmResults& arm, SeriesRole role,
                              const std::string& part, std::string& unit) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].role == role && results.all_series[f].part == part) {
            unit = results.all_series[f].unit;
            return &arm.totals.series[f];
        }
    return nullptr;
}

/// RMSE and its prediction. The ratio's interval uses the error of the mean square only, to first order: the prediction
/// varies far less from trial to trial.
Accuracy accuracy_of(const ScenarioResults& results, const ArmResults& arm, const std::string& group) {
    Accuracy accuracy{{}, {}, {}, {}, nan, nan, {nan, nan}, ""};
    const SeriesTotals* error = totals_of(results, arm, SeriesRole::squared_error, group, accuracy.unit);
    const SeriesTotals* variance = totals_of(results, arm, SeriesRole::variance, group, accuracy.unit);
    if (error == nullptr || variance == nullptr) return accuracy;
    for (std::size_t k = 0; k < error->sum.size(); ++k) {
        accuracy.square.push_back(moments_at(arm, *error, k, 1));
        accuracy.variance.push_back(moments_at(arm, *variance, k, 1));
        accuracy.rmse.push_back(std::sqrt(accuracy.square.back().mean));
        accuracy.predicted.push_back(std::sqrt(accuracy.variance.back().mean));
    }
    const Moments square = run_moments(arm, *error, results.steps(), 1);
    const double predicted = run_moments(arm, *variance, results.steps(), 1).mean;
    accuracy.over_steps = std::sqrt(square.mean);
    accuracy.ratio = std::sqrt(square.mean / predicted);
    const Interval interval = t_interval(square);
    accuracy.ratio_ci95 = {std::sqrt(std::max(0.0, interval.low) / predicted), std::sqrt(interval.high / predicted)};
    return accuracy;
}

/// Degrees of freedom of the NEES of all trials at a step. A series that has `rows` is of a state that grows.
double degrees_at(const ScenarioResults& results, const ArmResults& arm, std::size_t f, std::size_t k) {
    const Series& series = results.all_series[f];
    const SeriesTotals& totals = arm.totals.series[f];
    const auto count = static_cast<double>(arm.totals.counted_at(totals, k));
    if (!series.rows.empty())
        return totals_named(results, arm, series.rows)->sum[k].rounded() + count * series.more_rows;
    return totals.dimensions.empty() ? count * series.dimension : static_cast<double>(totals.dimensions[k]);
}

/// Ratios of a NEES to its dimension, over the run and step by step: the same for every chart of the error.
template <class Ratios>
void fill_ratios(const ScenarioResults& results, const ArmResults& arm, std::size_t f, Ratios& evidence) {
    const Series& series = results.all_series[f];
    const SeriesTotals& totals = arm.totals.series[f];
    evidence.name = series.part;
    evidence.dimension = series.dimension;
    evidence.run = run_moments(arm, totals, results.steps(), 1.0 / series.dimension);
    std::vector<double> sums;
    for (std::size_t k = 0; k < totals.sum.size(); ++k) {
        evidence.step.push_back(moments_at(arm, totals, k, 1.0 / series.dimension));
        evidence.anees.degrees.push_back(degrees_at(results, arm, f, k));
        sums.push_back(totals.sum[k].rounded());
        const bool grows = !totals.dimensions.empty() || !series.rows.empty();
        if (grows && evidence.anees.degrees.back() > 0)  // of NEES/dim times the whole dimension
            sums.back() *= evidence.anees.degrees.back() /
                           (static_cast<double>(arm.totals.counted_at(totals, k)) * series.dimension);
    }
    fill_bands(sums, evidence.anees);
}

bool within(double value, const Interval& interval) { return value >= interval.low && value <= interval.high; }

}  // namespace

const SeriesTotals* totals_named(const ScenarioResults& results, const ArmResults& arm, const std::string& name) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].name == name) return &arm.totals.series[f];
    return nullptr;
}

Moments run_moments(const ArmResults& arm, const SeriesTotals& totals, int steps, double scale) {
    return scaled(moments_from_sums(arm.totals.counted_in(totals), run_total(totals), totals.run_square_sum.rounded()),
                  scale / steps);
}

Moments moments_at(const ArmResults& arm, const SeriesTotals& totals, std::size_t k, double scale) {
    const double square = totals.square_sum.empty() ? nan : totals.square_sum[k].rounded();
    return scaled(moments_from_sums(arm.totals.counted_at(totals, k), totals.sum[k].rounded(), square), scale);
}

void fill_bands(const std::vector<double>& totals, BandedRatio& ratio) {
    for (const double degrees : ratio.degrees) ratio.observed += degrees > 0;
    double previous = 0;
    Interval band, simultaneous;
    for (std::size_t k = 0; k < totals.size(); ++k) {
        const double degrees = ratio.degrees[k];
        if (degrees != previous) {  // usually they are the same, and quantiles are slow
            band = degrees > 0 ? chi_square_band(degrees, 0.05) : Interval{nan, nan};
            simultaneous = degrees > 0 ? chi_square_band(degrees, 0.05 / ratio.observed) : Interval{nan, nan};
            previous = degrees;
        }
        ratio.ratio.push_back(degrees > 0 ? totals[k] / degrees : nan);
        ratio.band.push_back(degrees > 0 ? band : Interval{nan, nan});
        ratio.simultaneous_band.push_back(degrees > 0 ? simultaneous : Interval{nan, nan});
        ratio.outside += degrees > 0 && !within(ratio.ratio.back(), band);
        ratio.outside_simultaneous += degrees > 0 && !within(ratio.ratio.back(), simultaneous);
    }
}

GroupEvidence group_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f) {
    GroupEvidence evidence;
    fill_ratios(results, arm, f, evidence);
    for (const ComponentGroup& group : results.scenario.groups)
        for (int j = 0; group.name == evidence.name && j < group.count; ++j)
            evidence.components.push_back(group.component(j));
    for (std::size_t k = 0; k < evidence.step.size(); ++k) {
        const Moments& step = evidence.step[k];
        const double dimension = evidence.anees.degrees[k] / step.count,
                     deviation = step.standard_deviation * dimension;
        evidence.variance_ratio.push_back(deviation * deviation / (2 * dimension));
    }
    evidence.coverage = coverage_of(arm, arm.totals.series[f]);
    evidence.accuracy = accuracy_of(results, arm, evidence.name);
    return evidence;
}

ChartEvidence chart_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f) {
    ChartEvidence evidence;
    fill_ratios(results, arm, f, evidence);
    // The series is nees_CHART or nees_CHART_GROUP.
    const std::string rest = results.all_series[f].name.substr(std::string("nees_").size());
    evidence.chart = rest.substr(0, rest.find('_'));
    return evidence;
}

}  // namespace credence
