// Calibration given P: whether NEES is right where P is small and where it is large, which one mean over all hides
// (spread against skill, as of ensemble forecasts).

#include "statistics/mean_bounds.hpp"
#include "verdict/evidence_parts.hpp"
#include "verdict/judgement.hpp"

#include <credence/columns.hpp>
#include <credence/statistics.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr std::size_t quintiles = 5, least_trials = 20;  ///< of a quintile

/// The whole state's NEES/n of a trial, and its log det P, means over the steps.
struct CalibratedTrial {
    double log_det = 0, nees_ratio = 0;
};

/// Of the trials that count, by log det P; empty where trials or the columns are not kept.
std::vector<CalibratedTrial> trials_by_size(const ScenarioResults& results, const ArmResults& arm) {
    const auto column = [&](const char* name) {
        return static_cast<std::size_t>(std::ranges::find(results.columns, name, &Column::name) -
                                        results.columns.begin());
    };
    const std::size_t of_score = column("log_score"), of_nees = column("nees_ratio"), of_status = column("status");
    std::vector<CalibratedTrial> trials;
    if (arm.columns.empty() || std::max({of_score, of_nees, of_status}) == results.columns.size()) return trials;
    const double n = results.state_size();
    constexpr std::int64_t rows_at_once = std::int64_t{1} << 16;  // the columns of all trials may exceed the memory
    for (std::int64_t row = 0; row < results.trials; row += rows_at_once) {
        const std::int64_t rows = std::min(rows_at_once, results.trials - row);
        const std::vector<double> score = arm.columns.values(of_score, row, rows),
                                  nees = arm.columns.values(of_nees, row, rows),
                                  status = arm.columns.values(of_status, row, rows);
        for (std::size_t i = 0; i < score.size(); ++i)
            if (counts(static_cast<Status>(static_cast<int>(status[i]))) && std::isfinite(score[i]))
                // But for n log 2 pi, and without the rounding of NEES, which would sort trials of the same P by it.
                trials.push_back({std::round(1e6 * (2 * score[i] - n * nees[i])) / 1e6, nees[i]});
    }
    std::ranges::stable_sort(trials, {}, &CalibratedTrial::log_det);
    return trials;
}

}  // namespace

std::vector<Moments> quintiles_by_size(const ScenarioResults& results, const ArmResults& arm) {
    if (!results.has_joint_covariance) return {};
    const std::vector<CalibratedTrial> trials = trials_by_size(results, arm);
    if (trials.size() < quintiles * least_trials) return {};
    // Between the middles of the outer quintiles the variances of the state differ by 2 % at least.
    const double smaller = trials[trials.size() / 10].log_det, larger = trials[trials.size() * 9 / 10].log_det;
    if (!(larger - smaller > std::log(1.02) * results.state_size())) return {};
    std::vector<Moments> all;
    for (std::size_t quintile = 0; quintile < quintiles; ++quintile) {
        std::vector<double> ratios;
        for (std::size_t i = quintile * trials.size() / quintiles; i < (quintile + 1) * trials.size() / quintiles; ++i)
            ratios.push_back(trials[i].nees_ratio);
        all.push_back(moments_of(exact_moments(ratios)));
    }
    return all;
}

void judge_quintiles(const Evidence& evidence, Judgement& judgement) {
    if (evidence.quintiles.empty() || evidence.of_few_runs()) return;
    const GroupEvidence& state = evidence.groups.front();
    if (is_rounded(state, judgement.limits())) return;
    static const char* const places[quintiles] = {"smallest", "second smallest", "middle", "second largest", "largest"};
    const double margin = margins_of_part * judgement.limits().margin, level = levels::calibration / quintiles / 2;
    std::vector<std::string> beyond;
    for (std::size_t quintile = 0; quintile < quintiles; ++quintile) {
        const PositiveSample sample = positive_sample(evidence.quintiles[quintile]);
        const std::string when = std::string("the quintile of the trials with the ") + places[quintile] + " P";
        const double degrees = degrees_over_steps(sample, state.dimension, evidence.steps);
        const MeanClaim claim = claim_on_nees(sample, degrees, level, margin);
        if (claim.above || claim.below)
            judgement.add(claim.above ? Side::above : Side::below, {Subject::calibration, Fault{}, state.name, when,
                                                                    sample.mean, claim.bounds, "NEES/dim"});
        else if (std::abs(sample.mean - 1) > margin)
            beyond.push_back(when);
    }
    if (!beyond.empty())
        judgement.not_shown("NEES/dim of " + state.name + " in " + first_of(beyond) + ": beyond three times the margin",
                            true);
}

}  // namespace credence
