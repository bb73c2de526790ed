#include <credence/evidence.hpp>

#include "numeric/chi_square.hpp"
#include "statistics/goodness.hpp"
#include "statistics/moments/trial_moments.hpp"

#include "verdict/evidence_parts.hpp"
#include "base/nan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace credence {

namespace {

BiasEvidence bias_evidence(const ScenarioResults& results, const Series& series, const ArmResults& arm,
                           const SeriesTotals& totals) {
    std::string unit;
    for (const Component& component : results.scenario.components)
        if (component.name == series.part) unit = component.unit;
    BiasEvidence evidence{series.part, unit, run_moments(arm, totals, results.steps(), 1), {}, 0, {}};
    for (std::size_t k = 0; k < totals.sum.size(); ++k) evidence.step.push_back(moments_at(arm, totals, k, 1));
    return evidence;
}

/// The trial that a detailed row is of: of a record, the row itself.
std::int64_t trial_of(const ScenarioResults& results, std::size_t row) {
    const auto place = static_cast<std::int64_t>(row);
    return results.blocks.empty() ? place : trial_numbers(results, place, 1).front();
}

/// The largest error of the detailed trials, diverged ones too, by component.
void add_largest_errors(const ArmResults& arm, std::vector<BiasEvidence>& bias) {
    for (std::size_t i = 0; i < arm.errors.size(); ++i)
        if (double& largest = bias[i % bias.size()].largest_error; std::abs(arm.errors[i]) > largest)
            largest = std::abs(arm.errors[i]);
}

/// The size of the detailed trials' errors, by component.
void add_error_sizes(const ScenarioResults& results, const ArmResults& arm, std::vector<BiasEvidence>& bias) {
    const auto n = static_cast<std::size_t>(results.state_size()), steps = static_cast<std::size_t>(results.steps());
    if (bias.size() != n) return;
    add_largest_errors(arm, bias);
    for (std::size_t j = 0; j < n; ++j) {
        std::vector<double> sum(steps), count(steps);
        for (std::size_t i = j; i < arm.errors.size(); i += n) {
            const double error = std::abs(arm.errors[i]);
            if (std::isnan(error)) continue;
            sum[i / n % steps] += error * error;
            ++count[i / n % steps];
        }
        for (std::size_t k = 0; k < steps; ++k) bias[j].mean_square.push_back(sum[k] / count[k]);
    }
}

/// Rows of trials that did not fail. The file has the mean NEES of a group, the statistics want it per dimension.
std::shared_ptr<const TrialMoments> trial_moments(const ScenarioResults& results, const ArmResults& arm,
                                                  const std::vector<GroupEvidence>& groups) {
    const auto size = static_cast<std::size_t>(results.moment_count());
    if (size == 0 || arm.moments.empty() || groups.empty()) return nullptr;
    auto moments = std::make_shared<TrialMoments>();
    moments->components = results.state_size();
    moments->groups = static_cast<int>(groups.size());
    for (std::size_t row = 0; row < arm.moments.size() / size; ++row) {
        const double* from = arm.moments.data() + row * size;
        const auto is_nan = [](double value) { return std::isnan(value); };
        if (std::all_of(from, from + groups.size(), is_nan)) continue;  // the trial failed
        double* to = moments->append(trial_of(results, row));
        std::copy_n(from, size, to);
        for (std::size_t g = 0; g < groups.size(); ++g) to[g] /= groups[g].dimension;
    }
    return moments->trials() == 0 ? nullptr : moments;
}

template <class Value>
Moments moments_of_trials(const TrialMoments& trials, const Value& value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < trials.trials(); ++i)
        if (const double x = value(i); !std::isnan(x)) values.push_back(x);
    return moments_of(exact_moments(values));
}

template <class Value>
double largest_of(const TrialMoments& trials, const Value& value) {
    double largest = 0;
    for (std::size_t i = 0; i < trials.trials(); ++i) largest = std::fmax(largest, value(i));
    return largest;
}

/// NEES of each component by itself, but for those that are groups; and the largest trials.
void add_squares(Evidence& evidence) {
    if (!evidence.moments) return;
    const TrialMoments& moments = *evidence.moments;
    for (int g = 0; g < moments.groups; ++g)
        evidence.groups[static_cast<std::size_t>(g)].largest =
            largest_of(moments, [&](std::size_t i) { return moments.X(i, g); });
    if (std::ssize(evidence.bias) != moments.components) return;
    for (int j = 0; j < moments.components; ++j) {
        if (std::ranges::find(evidence.groups, std::vector<int>{j}, &GroupEvidence::components) !=
            evidence.groups.end())
            continue;
        const auto square = [&, at = triangle_place(j, j)](std::size_t i) {
            return moments.S(i)[at] / moments.C(i)[at];
        };
        BiasEvidence& bias = evidence.bias[static_cast<std::size_t>(j)];
        bias.square = moments_of_trials(moments, square);
        bias.largest_square = largest_of(moments, square);
    }
}

/// The trial of a detailed row; nothing where it has no NEES.
std::optional<WorstTrial> trial_by_nees(const ScenarioResults& results, const ArmResults& arm, std::size_t row) {
    const auto steps = static_cast<std::size_t>(results.steps());
    const double *first = arm.nees.data() + row * steps, *last = first + steps;
    double sum = 0, known = 0;
    const double* largest = first;
    for (const double* at = first; at != last; ++at)
        if (!std::isnan(*at)) sum += *at, ++known, largest = !(*largest >= *at) ? at : largest;
    if (known == 0) return std::nullopt;
    return WorstTrial{trial_of(results, row), sum / known / results.state_size(),
                      static_cast<int>(largest - first) + 1};
}

std::size_t detailed_rows(const ScenarioResults& results, const ArmResults& arm) {
    return arm.nees.size() / static_cast<std::size_t>(results.steps());
}

void keep_worst(std::vector<WorstTrial>& trials) {
    constexpr std::size_t most = 10;
    const auto end = trials.begin() + static_cast<std::ptrdiff_t>(std::min(most, trials.size()));
    std::partial_sort(trials.begin(), end, trials.end(),
                      [](const WorstTrial& a, const WorstTrial& b) { return a.nees_ratio > b.nees_ratio; });
    trials.erase(end, trials.end());
}

WorstTrials worst_trials(const ScenarioResults& results, const ArmResults& arm) {
    WorstTrials worst{{}, 0};
    double total = 0;
    for (std::size_t row = 0; row < detailed_rows(results, arm); ++row)
        if (const auto trial = trial_by_nees(results, arm, row)) {
            worst.trials.push_back(*trial);
            total += trial->nees_ratio;
        }
    keep_worst(worst.trials);
    for (const WorstTrial& trial : worst.trials) worst.share += trial.nees_ratio / total;
    return worst;
}

/// The arm without the details of its diverged trials, which are returned.
std::vector<WorstTrial> set_diverged_aside(const ScenarioResults& results, ArmResults& arm) {
    const std::size_t rows = detailed_rows(results, arm);
    std::vector<WorstTrial> diverged;
    for (std::size_t row = 0; row < rows; ++row) {
        const auto trial = trial_by_nees(results, arm, row);
        if (!trial || !(trial->nees_ratio > diverged_nees_ratio)) continue;
        diverged.push_back(*trial);
        for (std::vector<double>* values : {&arm.nees, &arm.errors, &arm.moments}) {
            const std::size_t width = values->size() / rows;
            std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(row * width), width, nan);
        }
    }
    keep_worst(diverged);
    return diverged;
}

/// Trials whose NEES at a step is in the distribution: cells are without diverged trials, whatever the series are.
double distribution_count(const Totals& totals, std::size_t k) {
    if (!totals.distribution_distance.empty() || totals.cells.empty())
        return static_cast<double>(totals.counted_at(totals.series.front(), k));
    const auto first = totals.cells.begin() + static_cast<std::ptrdiff_t>(k * distribution_cells);
    return static_cast<double>(std::accumulate(first, first + distribution_cells, std::int64_t{0}));
}

DistributionEvidence distribution_evidence(const ScenarioResults& results, const ArmResults& arm) {
    DistributionEvidence evidence;
    evidence.exact = !arm.totals.distribution_distance.empty();
    for (std::size_t k = 0; k < static_cast<std::size_t>(results.steps()); ++k) {
        evidence.distance.push_back(
            evidence.exact ? arm.totals.distribution_distance[k]
            : arm.totals.cells.empty()
                ? nan
                : cell_distance(arm.totals.cells.data() + k * distribution_cells, distribution_cells));
        const double count = distribution_count(arm.totals, k);
        evidence.p.push_back(count < 1 || std::isnan(evidence.distance.back())
                                 ? nan
                                 : kolmogorov_smirnov_p(evidence.distance.back(), count));
    }
    return evidence;
}

CredibilityEvidence credibility_evidence(const ScenarioResults& results, const ArmResults& arm) {
    CredibilityEvidence evidence;
    const std::size_t steps = static_cast<std::size_t>(results.steps()),
                      n = static_cast<std::size_t>(results.state_size()), trials = arm.nees.size() / steps;
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
    evidence.trials = arm.totals.trials.counted();
    evidence.all_trials = results.trials;
    const std::vector<std::int64_t>& statuses = arm.totals.trials.statuses;
    for (std::size_t status = 0; status < statuses.size(); ++status)
        if (failed(static_cast<Status>(status))) evidence.left_out += statuses[status];
    evidence.diverged = arm.totals.trials.diverged();
    evidence.diverged_are_judged = arm.totals.trials.diverged_count && evidence.diverged > 0;
}

/// What totals by step say, and the moments of the detailed trials.
Evidence means_and_series(const ScenarioResults& results, const ArmResults& arm) {
    Evidence evidence;
    count_trials(results, arm, evidence);
    evidence.steps = results.steps();
    evidence.joint = results.has_joint_covariance;
    for (std::size_t f = 0; f < results.all_series.size(); ++f) {
        const Series& series = results.all_series[f];
        if (series.role == SeriesRole::nees) evidence.groups.push_back(group_evidence(results, arm, f));
        if (series.role == SeriesRole::nees_in_chart) evidence.charts.push_back(chart_evidence(results, arm, f));
        if (series.role == SeriesRole::standardised_error)
            evidence.bias.push_back(bias_evidence(results, series, arm, arm.totals.series[f]));
        if (series.role == SeriesRole::nis)
            if (NisEvidence nis = nis_evidence(results, arm, f); nis.degrees > 0)
                evidence.nis.push_back(std::move(nis));
    }
    evidence.moments = trial_moments(results, arm, evidence.groups);
    add_squares(evidence);
    evidence.epsilon = results.epsilon;
    add_rounding(arm, evidence);
    return evidence;
}

Evidence evidence_of_counted(const ScenarioResults& results, const ArmResults& arm) {
    Evidence evidence = means_and_series(results, arm);
    evidence.whiteness = whiteness_evidence(results, arm, evidence.nis.empty() ? 1 : evidence.nis.front().ratio);
    evidence.distribution = distribution_evidence(results, arm);
    evidence.credibility = credibility_evidence(results, arm);
    evidence.worst = worst_trials(results, arm);
    add_error_sizes(results, arm, evidence.bias);
    evidence.quintiles = quintiles_by_size(results, arm);
    return evidence;
}

}  // namespace

double Evidence::may_be_unseen() const {
    if (of_few_runs() || all_trials < 2) return nan;
    return share_upper_bound(static_cast<double>(failed_trials()), static_cast<double>(all_trials), 0.05);
}

Evidence evidence_of(const ScenarioResults& results, const ArmResults& arm) {
    const TrialTotals& trials = arm.totals.trials;
    if (trials.diverged() == 0 || trials.diverged_count) return evidence_of_counted(results, arm);
    ArmResults all = arm, others = arm;
    all.totals.series = arm.totals.of_finite();
    all.totals.trials.diverged_count = true;
    if (trials.diverged() > trials.counted()) return evidence_of_counted(results, all);
    const std::vector<WorstTrial> diverged = set_diverged_aside(results, others);
    Evidence evidence = evidence_of_counted(results, others);
    evidence.diverged_trials = diverged;
    evidence.of_finite = std::make_shared<const Evidence>(means_and_series(results, all));
    if (evidence.bias.size() == static_cast<std::size_t>(results.state_size())) add_largest_errors(arm, evidence.bias);
    return evidence;
}

}  // namespace credence
