// What looks wrong and is not shown to be: how many trials would show it.

#include <algorithm>
#include <cmath>

#include "base/nan.hpp"
#include "statistics/moments/advice.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

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
