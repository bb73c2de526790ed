// The cautions beside a verdict.

#include "statistics/goodness.hpp"
#include "statistics/mean_bounds.hpp"
#include "statistics/whiteness.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

Interval interval_of(const Whiteness& lag) {
    return {lag.scaled - lag.simultaneous_bound, lag.scaled + lag.simultaneous_bound};
}

}  // namespace

/// With enough trials every filter has some correlation.
std::optional<Finding> correlation_found(const Evidence& evidence, double margin) {
    const Whiteness* worst = nullptr;
    std::vector<int> lags;
    for (const Whiteness& lag : evidence.whiteness) {
        if (!lag.known() || static_cast<double>(lag.count) < least_products ||
            !(std::abs(lag.scaled) - lag.simultaneous_bound > margin))
            continue;
        if (worst == nullptr || std::abs(lag.scaled) > std::abs(worst->scaled)) worst = &lag;
        lags.push_back(lag.lag);
    }
    if (worst == nullptr) return std::nullopt;
    return Finding{Subject::whiteness, Fault::correlated,   "innovations",         listed("lag", lags),
                   worst->scaled,      interval_of(*worst), "relative correlation"};
}

void caution_about_whiteness(const Evidence& evidence, Consistency& verdict) {
    if (const std::optional<Finding> found = correlation_found(evidence, verdict.limits.margin))
        verdict.cautions.push_back(*found);
}

/// Innovations of the wrong size beside a consistent state: NEES does not show them.
void caution_about_innovations(const Evidence& evidence, Consistency& verdict) {
    if (verdict.verdict != Verdict::consistent && verdict.verdict != Verdict::undecided) return;
    for (std::size_t i = 0; i < evidence.nis.size(); ++i) {
        const NisEvidence& nis = evidence.nis[i];
        const PositiveSample sample = positive_sample(nis.run);
        const double level =
                         level_of_group(levels::run, static_cast<int>(i), static_cast<int>(evidence.nis.size())) / 2,
                     degrees = std::min(nis.degrees, degrees_over_steps(sample, 1, nis.degrees / sample.trials));
        const MeanClaim claim = claim_on_nees(sample, degrees, level, verdict.limits.margin);
        if (claim.above || claim.below)
            verdict.cautions.push_back({Subject::innovations, claim.above ? Fault::optimistic : Fault::pessimistic,
                                        "innovations (" + nis.part + ")", "over all steps", nis.ratio, claim.bounds,
                                        "NIS/m"});
    }
}

/// A distance from chi-square that is significantly beyond the margin: Massart's bound on the distance of N values from
/// their own distribution, sqrt(ln(2/alpha)/(2 N)) [Massart 1990], corrected over the steps. A deviation that the size
/// of P already explains is not reported twice.
void caution_about_distribution(const Evidence& evidence, Consistency& verdict) {
    if (is_rounded(evidence.groups.front(), verdict.limits)) return;
    for (const Finding& finding : verdict.findings)
        if (finding.where == evidence.groups.front().name) return;
    std::vector<int> steps;
    Estimate worst;
    for (std::size_t k = 0; k < evidence.distribution.distance.size(); ++k) {
        const double count = evidence.groups.front().step[k].count, alpha = 0.05 / evidence.steps;
        const Estimate distance{evidence.distribution.distance[k], std::sqrt(std::log(2 / alpha) / (2 * count))};
        if (!(distance.interval().low > verdict.limits.margin)) continue;
        steps.push_back(static_cast<int>(k) + 1);
        if (distance.value > worst.value) worst = distance;
    }
    if (!steps.empty())
        verdict.cautions.push_back({Subject::distribution, Fault::non_chi_square, evidence.groups.front().name,
                                    steps_text(steps), worst.value, worst.interval(), "distance from chi-square"});
}

}  // namespace credence
