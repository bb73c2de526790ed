// How many trials would show that a filter is consistent, or that what looks wrong is.

#include "base/nan.hpp"
#include "statistics/moments/advice.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// The first trials: enough to know the spread, and few enough for a report of many arms. Groups that no trial has are
/// left out.
TrialMoments first_trials(const Evidence& evidence) {
    constexpr std::size_t most = 1024;
    const TrialMoments& all = *evidence.moments;
    std::vector<int> groups;
    for (int g = 0; g < all.groups; ++g)
        if (evidence.groups[static_cast<std::size_t>(g)].run.count > 0) groups.push_back(g);
    TrialMoments first{all.components, static_cast<int>(groups.size()), {}, {}};
    for (std::size_t i = 0; i < std::min(most, all.trials()); ++i) {
        double* to = first.append(all.trial[i]);
        for (const int g : groups) *to++ = all.X(i, g);
        std::copy(all.row(i) + all.groups, all.row(i) + all.size(), to);
    }
    return first;
}

constexpr double suspected = 0.05;  ///< the level of a suspicion, one-sided and uncorrected

/// `trials` of a mean that is so far away, for the mean and for the two ends of its interval. Nothing for too few
/// trials to know the spread, and where the number is no more than the study has: then something else withholds the
/// finding.
template <class Trials>
std::optional<TrialsNeeded> needed(const Trials& trials, double half_width, double count) {
    if (count < advice_trials) return std::nullopt;
    const double fewer = trials(half_width), as_seen = trials(0), more = trials(-half_width);
    if (!(as_seen > count) || !std::isfinite(more)) return std::nullopt;
    return TrialsNeeded{to_two_digits(std::max(fewer, count)), to_two_digits(as_seen), to_two_digits(more)};
}

}  // namespace

/// The relative spread stays what it is; the mean is one that nine of ten studies are beyond.
Interval smallest_faults(const Evidence& evidence, const Limits& limits) {
    if (evidence.groups.empty() || evidence.has_offsets()) return {nan, nan};
    const GroupEvidence& state = evidence.groups.front();
    const double level = level_of_group(levels::run, 0, groups_judged(evidence)) / 2,
                 error = normal_quantile(0.2) * state.run.standard_error / state.run.mean;
    const auto is_found = [&](double fault) {
        PositiveSample sample = positive_sample(state.run, state.largest);
        const double mean = fault * (fault > 1 ? 1 - error : 1 + error), scale = fault / sample.mean;
        sample = {sample.trials, mean, sample.standard_deviation * scale, sample.largest * scale};
        const MeanClaim claim = claim_on_size(sample, state.dimension, level, evidence, limits.margin);
        return fault > 1 ? claim.above : claim.below;
    };
    const auto smallest = [&](double most) {
        if (!is_found(most)) return nan;
        double missed = 0, found = std::log(most);
        for (int i = 0; i < 30; ++i) {
            const double middle = (missed + found) / 2;
            (is_found(std::exp(middle)) ? found : missed) = middle;
        }
        return std::exp(found);
    };
    return {smallest(0.01), smallest(100)};
}

TrialsNeeded trials_needed(const Evidence& evidence, const Limits& limits) {
    if (!evidence.moments || evidence.groups.empty() || !evidence.joint) return {};
    const std::vector<int> state = uncertain_components(evidence, evidence.groups.front().components);
    constexpr std::uint64_t seed = 1;  // the same advice for the same trials
    const std::optional<Advice> advice =
        trials_for_consistent(first_trials(evidence), state, seed, {limits.margin, limits.direction, limits.bias});
    if (!advice) return {};
    return {to_two_digits(advice->range.low), to_two_digits(advice->trials), to_two_digits(advice->range.high)};
}

double to_two_digits(double trials) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(trials)) - 1));
    return std::round(trials / unit) * unit;
}

std::optional<Suspicion> suspicion_of(const PositiveSample& sample, double level, double margin) {
    const bool above = lower_bound(sample, suspected) > 1 + margin;
    if (!above && !(upper_bound(sample, suspected) < 1 - margin)) return std::nullopt;
    const auto trials = [&](double farther) {
        PositiveSample moved = sample;
        moved.mean += above ? farther : -farther;
        return trials_to_show(moved, level, margin);
    };
    const auto number = needed(trials, sample.mean - lower_bound(sample, suspected), sample.trials);
    if (!number) return std::nullopt;
    return Suspicion{Subject::size, fault_of(above ? Side::above : Side::below), "", sample.mean, "", *number};
}

std::optional<Suspicion> suspicion_of_bias(const Moments& z, double level, double margin) {
    const Interval seen = t_interval(z, 2 * suspected);
    if (!(seen.low > margin) && !(seen.high < -margin)) return std::nullopt;
    const auto trials = [&](double farther) {
        Moments moved = z;
        moved.mean += moved.mean > 0 ? farther : -farther;
        return trials_to_show_bias(moved, level, margin);
    };
    const auto number = needed(trials, (seen.high - seen.low) / 2, z.count);
    if (!number) return std::nullopt;
    return Suspicion{Subject::bias, Fault::biased, "", z.mean, "", *number};
}

}  // namespace credence
