// The verdict's bias: mean errors against a margin, over all steps.

#include "statistics/moments/bias.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// The steps whose mean error is farthest from 0, for the text alone.
std::string worst_step(const BiasEvidence& bias) {
    const auto size = [](const Moments& step) { return std::isnan(step.mean) ? 0 : std::abs(step.mean); };
    const auto worst = std::max_element(bias.step.begin(), bias.step.end(),
                                        [&](const Moments& a, const Moments& b) { return size(a) < size(b); });
    return "over all steps, most at step " + std::to_string(worst - bias.step.begin() + 1);
}

void judge_suspicion(const BiasEvidence& bias, int components, Judgement& judgement) {
    const double level = levels::bias / components / 2;
    if (std::optional<Suspicion> looks = suspicion_of_bias(bias.run, level, judgement.limits().bias))
        judgement.suspect(
            {Subject::bias, Fault::biased, bias.component, looks->value, "mean error/sigma", looks->trials});
}

}  // namespace

void judge_bias(const Evidence& evidence, Judgement& judgement) {
    for (const BiasEvidence& bias : evidence.bias) {
        // A record that does not give this component's sigma.
        if (!(bias.run.count > 0) && evidence.trials > 0) continue;
        const BiasClaim claim = claim_on_bias(bias.run, bias.largest_error, static_cast<int>(evidence.bias.size()),
                                              judgement.limits().bias);
        if (claim.finding)
            judgement.add_bias({Subject::bias, Fault::biased, bias.component, worst_step(bias), claim.value,
                                claim.interval, "mean error/sigma"});
        else if (!claim.known_exactly)
            judge_suspicion(bias, static_cast<int>(evidence.bias.size()), judgement);
        judgement.reach(&Reached::bias, claim.shown);
        judgement.accept(claim.accepted, "bias of " + bias.component);
    }
}

}  // namespace credence
