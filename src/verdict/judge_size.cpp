// The verdict's size: NEES/dimension over all steps, of the named groups and of every component by itself.

#include <algorithm>

#include "base/formatted.hpp"
#include "verdict/judgement.hpp"

namespace credence {

int groups_judged(const Evidence& evidence) {
    const auto is_group = [](const BiasEvidence& bias) { return bias.square.count > 0; };
    return static_cast<int>(std::ssize(evidence.groups) + std::ranges::count_if(evidence.bias, is_group));
}

bool has_offset(const BiasEvidence& bias, const Evidence& evidence, const Limits& limits) {
    const Interval interval = t_interval(bias.run, levels::bias / static_cast<double>(evidence.bias.size()));
    return bias.drift != 0 || interval.low > limits.bias || interval.high < -limits.bias;
}

/// Errors about their mean are too small by construction, and errors with an offset are no smaller than it is.
void withhold_too_small(const JudgedSize& size, const Interval& bounds, const Evidence& evidence,
                        Judgement& judgement) {
    for (const int j : size.components)
        if (j < std::ssize(evidence.bias) &&
            has_offset(evidence.bias[static_cast<std::size_t>(j)], evidence, judgement.limits()))
            return;
    judgement.withhold("P is larger than the errors of " +
                       (evidence.trials == 1 ? "this run" : "these " + std::to_string(evidence.trials) + " runs") +
                       ": NEES/dim of " + size.name +
                       formatted(" %.3g (%.3g to %.3g)", size.sample.mean, bounds.low, bounds.high));
}

MeanClaim claim_on_size(PositiveSample sample, int dimension, double level, const Evidence& evidence, double margin) {
    sample.of_few_numbers = evidence.steps_together() * dimension < many_numbers;
    if (!evidence.segments.count && !sample.of_few_numbers) sample.largest = 0;
    return claim_on_nees(sample, degrees_over_steps(sample, dimension, evidence.steps_together()), level, margin);
}

void judge_size(const JudgedSize& size, int place, const Evidence& evidence, Judgement& judgement) {
    const double level = level_of_group(levels::run, place, groups_judged(evidence)) / 2,
                 margin = judgement.limits().margin;
    const auto claim_on = [&](const PositiveSample& sample) {
        return claim_on_size(sample, size.dimension, level, evidence, margin);
    };
    const auto add = [&](Side side, const PositiveSample& sample, const MeanClaim& claim) {
        judgement.add(side,
                      {Subject::size, Fault{}, size.name, "over all steps", sample.mean, claim.bounds, "NEES/dim"});
    };
    const PositiveSample& large = evidence.has_offsets() && size.centred.trials > 0 ? size.centred : size.sample;
    const MeanClaim above = claim_on(large), below = claim_on(size.sample);
    // Of runs that are too few to tell what was drawn once, unless no such draw explains it.
    const auto beyond_draws = [&] {
        const double least = bounds_at_any_correlation(static_cast<double>(evidence.trials), size.dimension, level).low;
        return size.sample.mean / least < 1 - margin;
    };
    const bool is_small = below.below && (!evidence.has_offsets() || beyond_draws());
    if (above.above)
        add(Side::above, large, above);
    else if (is_small)
        add(Side::below, size.sample, below);
    else if (below.below)
        withhold_too_small(size, below.bounds, evidence, judgement);
    else if (std::optional<Suspicion> looks = suspicion_of(large, level, margin);
             looks && (looks->what == Fault::optimistic || !evidence.has_offsets()))
        judgement.suspect({Subject::size, looks->what, size.name, looks->value, "NEES/dim", looks->trials});
}

void judge_components(const Evidence& evidence, Judgement& judgement) {
    auto place = static_cast<int>(evidence.groups.size());
    for (std::size_t j = 0; j < evidence.bias.size(); ++j) {
        const BiasEvidence& bias = evidence.bias[j];
        if (!(bias.square.count > 0)) continue;
        const std::vector<int> alone{static_cast<int>(j)};
        if (!uncertain_components(evidence, alone).empty())
            judge_size({bias.component, 1, alone, positive_sample(bias.square, bias.largest_square),
                        positive_sample(bias.centred)},
                       place, evidence, judgement);
        ++place;
    }
}

}  // namespace credence
