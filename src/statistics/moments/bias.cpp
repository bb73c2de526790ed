#include "statistics/moments/bias.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/mean_bounds.hpp"

namespace credence {

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
