#include "statistics/mean_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

double half_width(const PositiveSample& sample, double level) {
    return t_quantile(2 * level, sample.trials - 1) * sample.standard_deviation / std::sqrt(sample.trials);
}

}  // namespace

double level_of_group(double level, int g, int groups) {
    if (groups == 1) return level;
    return g == 0 ? level / 2 : level / (2 * (groups - 1));
}

PositiveSample positive_sample(const Moments& moments, double largest) {
    return {moments.count, moments.mean, moments.standard_deviation, largest};
}

double unseen_share(double level, double trials) { return -std::expm1(std::log(level) / trials); }

double lower_bound(const PositiveSample& sample, double level) { return sample.mean - half_width(sample, level); }

double upper_bound(const PositiveSample& sample, double level) { return sample.mean + half_width(sample, level); }

MeanClaim claim_on_mean(const PositiveSample& sample, double level, double margin, double unseen) {
    const double size = sample.of_few_numbers ? unseen_size - sample.mean : (unseen_size - 1) * sample.mean;
    if (sample.of_few_numbers) unseen = std::min(unseen, levels::unseen_of_few);
    const double missed = unseen_share(unseen, sample.trials) * std::max(0.0, size) +
                          std::max(0.0, sample.largest - sample.mean) / sample.trials;
    MeanClaim claim;
    claim.bounds = {lower_bound(sample, level), upper_bound(sample, level) + missed};
    claim.above = claim.bounds.low > 1 + margin;
    claim.below = claim.bounds.high < 1 - margin;
    return claim;
}

MeanClaim claim_on_nees(const PositiveSample& sample, double degrees, double level, double margin, double unseen) {
    MeanClaim claim = claim_on_mean(sample, level, margin, unseen);
    const double total = sample.mean * degrees;
    claim.above = claim.above && total / (1 + margin) > chi_square_upper_quantile(level, degrees);
    claim.below = claim.below && total / (1 - margin) < chi_square_quantile(level, degrees);
    return claim;
}

double degrees_over_steps(const PositiveSample& sample, int dimension, double steps) {
    const double fewest = sample.trials * dimension;
    const double estimated = 2 * sample.trials * std::pow(sample.mean / sample.standard_deviation, 2);
    return estimated > fewest ? std::min(estimated, fewest * steps) : fewest;
}

Interval acceptance_interval(const PositiveSample& smallest, const PositiveSample& largest) {
    return {lower_bound(smallest, levels::acceptance), upper_bound(largest, levels::acceptance)};
}

double margin_shown(const Interval& interval) { return std::max(1 - interval.low, interval.high - 1); }

BiasClaim claim_on_bias(const Moments& z, double largest_error, int components, double margin) {
    BiasClaim claim;
    const double corrected = levels::bias / components;  // two-sided
    claim.value = z.mean;
    claim.interval = t_interval(z, corrected);
    claim.known_exactly = largest_error <= rounding_error || (z.standard_deviation == 0 && std::abs(z.mean) <= margin);
    if (claim.known_exactly) {
        claim.accepted = true;
        return claim;
    }
    claim.finding = claim.interval.low > margin || claim.interval.high < -margin;
    const Interval inside = t_interval(z, 2 * levels::acceptance);
    claim.accepted = inside.low >= -margin && inside.high <= margin;
    claim.shown = std::max(-inside.low, inside.high);
    return claim;
}

}  // namespace credence
