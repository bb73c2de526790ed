// Innovations: their evidence, and the verdict on a record of them alone, which is whether they are correlated.

#include "base/nan.hpp"
#include "statistics/goodness.hpp"
#include "statistics/whiteness.hpp"
#include "verdict/evidence_parts.hpp"
#include "verdict/judgement.hpp"

#include <cmath>

namespace credence {

namespace {

/// Number of rows of a NIS at a step, summed over all trials [docs/statistics.md, NIS]: they vary, so it is not trials
/// times rows.
double rows_at(const Series& nis, const SeriesTotals* rows, const ArmResults& arm, std::size_t k) {
    const double counted = rows == nullptr ? 0 : rows->sum[k].rounded();
    return counted + static_cast<double>(nis.more_rows) * static_cast<double>(arm.totals.counted_at(k));
}

/// Number of trials whose innovations were correlated: the detailed ones of a study, all of a record.
double correlated_trials(const ScenarioResults& results, const ArmResults& arm) {
    if (results.blocks.empty()) return static_cast<double>(arm.totals.trials.counted());
    const auto steps = static_cast<std::size_t>(results.steps());
    double trials = 0;
    for (std::size_t row = 0; row < arm.nees.size(); row += steps) trials += !std::isnan(arm.nees[row]);
    return trials;
}

/// Sums of a lag, the number of products taken as the same in every trial: the files keep its total alone.
LagSums lag_sums(const ProductTotals& products, std::size_t lag, double trials, double scale) {
    const double count = static_cast<double>(products.count[lag]), each = count / trials,
                 sum = products.sum[lag].rounded();
    return {trials, sum, products.square_sum[lag].rounded(), sum * each, count, count * each, count * scale * scale};
}

}  // namespace

NisEvidence nis_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f) {
    const Series& series = results.all_series[f];
    const SeriesTotals* rows = totals_named(results, arm, series.rows);
    NisEvidence evidence{series.part, {}, 0, nan, {nan, nan}, {nan, nan}};
    ExactSum total;
    std::vector<double> totals;
    for (std::size_t k = 0; k < arm.totals.series[f].sum.size(); ++k) {
        evidence.nis.degrees.push_back(rows_at(series, rows, arm, k));
        evidence.degrees += evidence.nis.degrees.back();
        totals.push_back(arm.totals.series[f].sum[k].rounded());
        total.add(arm.totals.series[f].sum[k]);
    }
    fill_bands(totals, evidence.nis);
    if (evidence.degrees > 0) {
        evidence.ratio = total.rounded() / evidence.degrees;
        const Interval band = chi_square_band(evidence.degrees, 0.05);
        evidence.scale95 = {evidence.ratio / band.high, evidence.ratio / band.low};
        const Moments run = moments_from_sums(arm.totals.trials.counted(), total.rounded(),
                                              arm.totals.series[f].run_square_sum.rounded());
        const double rows_a_trial = evidence.degrees / run.count,
                     half = t_quantile(0.05, run.count - 1) * run.standard_error / rows_a_trial;
        evidence.ratio95 = {evidence.ratio - half, evidence.ratio + half};
        evidence.run = {run.count, evidence.ratio, run.standard_deviation / rows_a_trial,
                        run.standard_error / rows_a_trial};
    }
    return evidence;
}

std::vector<Whiteness> whiteness_evidence(const ScenarioResults& results, const ArmResults& arm, double scale) {
    const ProductTotals& products = arm.totals.products;
    const double trials = correlated_trials(results, arm);
    std::vector<Whiteness> evidence;
    const double lags = static_cast<double>(products.sum.size());
    for (std::size_t lag = 0; lag < products.sum.size(); ++lag) {
        if (products.count[lag] == 0) continue;
        const LagSums sums = lag_sums(products, lag, trials, scale);
        const auto bound = [&](double alpha) {
            const std::optional<LagCorrelation> correlation = correlation_of(sums, alpha);
            // Of few products the bound is shown, and not used [cautions.cpp].
            return correlation ? (correlation->interval.high - correlation->interval.low) / 2 / scale
                               : normal_quantile(alpha) / std::sqrt(sums.c);
        };
        const double mean = sums.p / sums.c;
        evidence.push_back(
            {static_cast<int>(lag) + 1, products.count[lag], mean, mean / scale, bound(0.05), bound(0.05 / lags)});
    }
    return evidence;
}

bool Whiteness::known() const { return std::isfinite(scaled); }

void judge_innovations(const Evidence& evidence, Judgement& judgement) {
    if (!evidence.of_innovations) return;
    if (const std::optional<Finding> found = correlation_found(evidence, judgement.limits().margin))
        judgement.add_correlation(*found);
}

}  // namespace credence
