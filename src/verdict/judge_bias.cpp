// The verdict's bias: mean errors against a margin, over all steps.

#include "statistics/mean_bounds.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// The steps whose mean error is farthest from 0, for the text alone.
std::string worst_step(const BiasEvidence& bias) {
    const auto size = [](const Moments& step) { return std::isnan(step.mean) ? 0 : std::abs(step.mean); };
    const auto worst = std::ranges::max_element(bias.step, {}, size);
    return "over all steps, most at step " + std::to_string(worst - bias.step.begin() + 1);
}

void judge_suspicion(const BiasEvidence& bias, int components, Judgement& judgement) {
    const double level = levels::bias / components / 2;
    if (std::optional<Suspicion> looks = suspicion_of_bias(bias.run, level, judgement.limits().bias))
        judgement.suspect(
            {Subject::bias, Fault::biased, bias.component, looks->value, "mean error/sigma", looks->trials});
}

double nearest_to_0(const BiasClaim& claim) {
    return std::min(std::abs(claim.interval.low), std::abs(claim.interval.high));
}

/// Of runs too few to tell them from what was drawn once: an offset or a drift is a note, and a mean that is beyond one
/// draw of each run a finding.
void judge_offset(const BiasEvidence& bias, const BiasClaim& claim, const Evidence& evidence, Judgement& judgement) {
    const std::string several = "once in a run; five runs can tell";
    if (bias.drift != 0)
        judgement.note({Subject::offset,
                        Fault::biased,
                        bias.component,
                        "drift over the run, of the filter or drawn " + several,
                        bias.drift,
                        {bias.drift - bias.drift_half_width, bias.drift + bias.drift_half_width},
                        "drift/sigma"});
    if (!claim.finding) return;
    constexpr double one_draw = 3.2;
    if (nearest_to_0(claim) >
        one_draw / std::sqrt(static_cast<double>(evidence.trials)) + truth_allowance(bias.truth, evidence))
        judgement.add_bias({Subject::bias, Fault::biased, bias.component, worst_step(bias), claim.value, claim.interval,
                            "mean error/sigma"});
    else
        judgement.note({Subject::offset, Fault::biased, bias.component, "over all steps: a bias, or drawn " + several,
                        claim.value, claim.interval, "mean error/sigma"});
}

}  // namespace

double truth_allowance(double share, const Evidence& evidence) {
    return share > 0 ? share * normal_quantile(levels::bias / static_cast<double>(evidence.bias.size())) : 0;
}

void judge_bias(const Evidence& evidence, Judgement& judgement) {
    for (const BiasEvidence& bias : evidence.bias) {
        // A record that does not give this component's sigma.
        if (!(bias.run.count > 0) && evidence.trials > 0) continue;
        BiasClaim claim = claim_on_bias(bias.run, bias.largest_error, static_cast<int>(evidence.bias.size()),
                                        judgement.limits().bias);
        claim.finding = claim.finding &&
                        nearest_to_0(claim) > judgement.limits().bias + truth_allowance(bias.truth, evidence);
        if (evidence.has_offsets())
            judge_offset(bias, claim, evidence, judgement);
        else if (claim.finding)
            judgement.add_bias({Subject::bias, Fault::biased, bias.component, worst_step(bias), claim.value,
                                claim.interval, "mean error/sigma"});
        else if (!claim.known_exactly)
            judge_suspicion(bias, static_cast<int>(evidence.bias.size()), judgement);
        judgement.reach(&Reached::bias, claim.shown);
        judgement.accept(claim.accepted, "bias of " + bias.component);
    }
}

}  // namespace credence
