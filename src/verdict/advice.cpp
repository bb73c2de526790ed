// How many trials would show that a filter is consistent.

#include "statistics/advice.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// The first trials: enough to know the spread, and few enough for a report of many arms.
TrialMoments first_trials(const TrialMoments& all) {
    constexpr std::size_t most = 1024;
    const std::size_t count = std::min(most, all.trials());
    TrialMoments first{all.components, all.groups, {}, {}};
    first.trial.assign(all.trial.begin(), all.trial.begin() + static_cast<std::ptrdiff_t>(count));
    first.values.assign(all.values.data(), all.values.data() + count * all.size());
    return first;
}

/// To two digits.
double rounded(double trials) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(trials)) - 1));
    return std::round(trials / unit) * unit;
}

}  // namespace

TrialsNeeded trials_needed(const Evidence& evidence, const Limits& limits) {
    if (!evidence.moments || evidence.groups.empty() || !evidence.joint) return {};
    const std::vector<int> state = uncertain_components(evidence, evidence.groups.front().components);
    constexpr std::uint64_t seed = 1;  // the same advice for the same trials
    const std::optional<Advice> advice = trials_for_consistent(first_trials(*evidence.moments), state, seed,
                                                               {limits.margin, limits.direction, limits.bias});
    if (!advice) return {};
    return {rounded(advice->range.low), rounded(advice->trials), rounded(advice->range.high)};
}

}  // namespace credence
