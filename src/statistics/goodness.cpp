#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include "statistics/goodness.hpp"

#include "base/nan.hpp"
#include "statistics/autocorrelation.hpp"

namespace credence {

namespace {

/// Lower end of Wilson's interval, in a form without cancellation for few successes, and 0 for none.
double wilson_low(double successes, double trials, double z) {
    const double failures = trials - successes;
    const double root = z * std::sqrt(z * z + 4 * successes * failures / trials);
    return (2 * successes + z * z - root) / (2 * (trials + z * z));
}

/// Without NaN, in order.
void put_in_order(std::vector<double>& values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    std::sort(values.begin(), values.end());
}

/// Of probabilities in order.
double distance_of_sorted(const std::vector<double>& probabilities) {
    if (probabilities.empty()) return nan;
    const double n = static_cast<double>(probabilities.size());
    double greatest = 0;
    for (std::size_t i = 0; i < probabilities.size(); ++i) {
        const double p = probabilities[i], below = static_cast<double>(i);
        greatest = std::max({greatest, (below + 1) / n - p, p - below / n});
    }
    return greatest;
}

}  // namespace

double share_upper_bound(double count, double trials, double level) {
    if (!(trials > 0)) return std::numeric_limits<double>::quiet_NaN();
    if (count >= trials) return 1;
    const double odds = (count + 1) / (trials - count) * f_upper_quantile(level, 2 * (count + 1), 2 * (trials - count));
    return odds / (1 + odds);
}

Interval wilson_interval(double successes, double trials, double alpha) {
    if (!(trials > 0)) return {nan, nan};
    const double z = normal_quantile(alpha);
    return {wilson_low(successes, trials, z), 1 - wilson_low(trials - successes, trials, z)};
}

Interval chi_square_band(double degrees, double alpha) {
    return {chi_square_quantile(alpha / 2, degrees) / degrees, chi_square_upper_quantile(alpha / 2, degrees) / degrees};
}

double chi_square_p(double statistic, double degrees) {
    if (std::isnan(statistic) || !(degrees > 0)) return nan;
    if (statistic <= 0) return 1;
    if (std::isinf(statistic)) return 0;
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), statistic));
}

double uniform_distance(std::vector<double> probabilities) {
    put_in_order(probabilities);
    return distance_of_sorted(probabilities);
}

double cell_distance(const std::int64_t* counts, int cells) {
    std::int64_t total = 0, below = 0;
    for (int i = 0; i < cells; ++i) total += counts[i];
    if (total == 0) return nan;
    double greatest = 0;
    for (int i = 0; i < cells; ++i) {
        below += counts[i];
        const double share = static_cast<double>(below) / static_cast<double>(total);
        greatest = std::max(greatest, std::abs(share - (i + 1.0) / cells));
    }
    return greatest;
}

}  // namespace credence
