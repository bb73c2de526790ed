#include <credence/evidence.hpp>

#include "numeric/chi_square.hpp"
#include "statistics/goodness.hpp"

#include "verdict/evidence_parts.hpp"
#include "base/nan.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

const SeriesTotals* totals_named(const ScenarioResults& results, const ArmResults& arm, const std::string& name) {
    for (std::size_t f = 0; f < results.all_series.size(); ++f)
        if (results.all_series[f].name == name) return &arm.totals[f];
    return nullptr;
}

/// Number of rows of a NIS at a step, summed over all trials [docs/statistics.md, NIS]: they vary, so it is not trials
/// times rows.
double rows_at(const Series& nis, const SeriesTotals* rows, const ArmResults& arm, std::size_t k) {
    const double counted = rows == nullptr ? 0 : rows->sum[k].rounded();
    return counted + static_cast<double>(nis.more_rows) * static_cast<double>(arm.counted_at(k));
}

NisEvidence nis_evidence(const ScenarioResults& results, const ArmResults& arm, std::size_t f) {
    const Series& series = results.all_series[f];
    const SeriesTotals* rows = totals_named(results, arm, series.rows);
    NisEvidence evidence{series.part, {}, 0, nan, {nan, nan}, {nan, nan}};
    ExactSum total;
    std::vector<double> totals;
    for (std::size_t k = 0; k < arm.totals[f].sum.size(); ++k) {
        evidence.nis.degrees.push_back(rows_at(series, rows, arm, k));
        evidence.degrees += evidence.nis.degrees.back();
        totals.push_back(arm.totals[f].sum[k].rounded());
        total.add(arm.totals[f].sum[k]);
    }
    fill_bands(totals, evidence.nis);
    if (evidence.degrees > 0) {
        evidence.ratio = total.rounded() / evidence.degrees;
        const Interval band = chi_square_band(evidence.degrees, 0.05);
        evidence.scale95 = {evidence.ratio / band.high, evidence.ratio / band.low};
        const Moments run = moments_from_sums(arm.counted, total.rounded(), arm.totals[f].run_square_sum.rounded());
        const double rows_a_trial = evidence.degrees / run.count,
                     half = t_quantile(0.05, run.count - 1) * run.standard_error / rows_a_trial;
        evidence.ratio95 = {evidence.ratio - half, evidence.ratio + half};
    }
    return evidence;
}

/// `scale` NIS/m. The bounds hold for innovations of the right size; otherwise the products are off by that factor.
std::vector<Whiteness> whiteness_evidence(const ProductTotals& products, double scale) {
    std::vector<Whiteness> evidence;
    const double lags = static_cast<double>(products.sum.size());
    for (std::size_t lag = 0; lag < products.sum.size(); ++lag) {
        const double count = static_cast<double>(products.count[lag]);
        if (count == 0) continue;
        const double mean = products.sum[lag].rounded() / count;
        evidence.push_back({static_cast<int>(lag) + 1, products.count[lag], mean, mean / scale,
                            normal_quantile(0.05) / std::sqrt(count), normal_quantile(0.05 / lags) / std::sqrt(count)});
    }
    return evidence;
}

BiasEvidence bias_evidence(const Series& series, const ArmResults& arm, const SeriesTotals& totals) {
    BiasEvidence evidence{series.part, {}};
    for (std::size_t k = 0; k < totals.sum.size(); ++k) evidence.step.push_back(moments_at(arm, totals, k, 1));
    return evidence;
}

DistributionEvidence shape_evidence(const ScenarioResults& results, const ArmResults& arm) {
    DistributionEvidence evidence;
    evidence.exact = !arm.distribution_distance.empty();
    for (std::size_t k = 0; k < static_cast<std::size_t>(results.steps()); ++k) {
        evidence.distance.push_back(evidence.exact       ? arm.distribution_distance[k]
                                    : arm.cells.empty() ? nan
                                                        : cell_distance(arm.cells.data() + k * distribution_cells, distribution_cells));
        const double count = static_cast<double>(arm.counted_at(arm.totals.front(), k));
        evidence.p.push_back(count < 1 || std::isnan(evidence.distance.back()) ? nan : kolmogorov_smirnov_p(evidence.distance.back(), count));
    }
    return evidence;
}

CredibilityEvidence credibility_evidence(const ScenarioResults& results, const ArmResults& arm) {
    CredibilityEvidence evidence;
    const std::size_t steps = static_cast<std::size_t>(results.steps()), n = static_cast<std::size_t>(results.state_size()),
                      trials = arm.nees.size() / steps;
    double known = 0;
    for (std::size_t k = 0; k < steps; ++k) {
        std::vector<double> nees, errors;
        for (std::size_t trial = 0; trial < trials; ++trial) {
            const std::size_t row = trial * steps + k;
            nees.push_back(arm.nees[row]);
            errors.insert(errors.end(), arm.errors.begin() + static_cast<std::ptrdiff_t>(row * n),
                          arm.errors.begin() + static_cast<std::ptrdiff_t>((row + 1) * n));
        }
        evidence.step.push_back(credibility(nees, errors, static_cast<int>(n)));
        if (std::isnan(evidence.step.back().nci)) continue;
        ++known;
        evidence.nci += evidence.step.back().nci;
        evidence.inclination += evidence.step.back().inclination;
    }
    evidence.nci /= known;  // NaN where no step is known
    evidence.inclination /= known;
    return evidence;
}

void count_trials(const ScenarioResults& results, const ArmResults& arm, Evidence& evidence) {
    evidence.trials = arm.counted;
    evidence.all_trials = results.trials;
    const std::vector<std::int64_t> statuses = status_counts(results, arm);
    for (std::size_t status = 0; status < statuses.size(); ++status)
        if (failed(static_cast<Status>(status))) evidence.left_out += statuses[status];
    evidence.diverged = statuses[static_cast<std::size_t>(Status::diverged)];
}

}  // namespace

bool Whiteness::known() const { return std::isfinite(scaled); }

Evidence evidence_of(const ScenarioResults& results, const ArmResults& arm) {
    Evidence evidence;
    count_trials(results, arm, evidence);
    evidence.steps = results.steps();
    evidence.joint = results.has_joint_covariance;
    for (std::size_t f = 0; f < results.all_series.size(); ++f) {
        const Series& series = results.all_series[f];
        if (series.role == SeriesRole::nees) evidence.blocks.push_back(block_evidence(results, arm, f));
        if (series.role == SeriesRole::nees_in_chart) evidence.charts.push_back(chart_evidence(results, arm, f));
        if (series.role == SeriesRole::standardised_error)
            evidence.bias.push_back(bias_evidence(series, arm, arm.totals[f]));
        if (series.role == SeriesRole::nis)
            if (NisEvidence nis = nis_evidence(results, arm, f); nis.degrees > 0) evidence.nis.push_back(std::move(nis));
    }
    evidence.whiteness = whiteness_evidence(arm.products, evidence.nis.empty() ? 1 : evidence.nis.front().ratio);
    evidence.shape = shape_evidence(results, arm);
    evidence.credibility = credibility_evidence(results, arm);
    return evidence;
}

}  // namespace credence
