#include "statistics/whiteness.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr double enough_trials_for_spread = 8;

/// Half-width by the spread of trials, in sums: sum (p - r c)^2 = pp - 2 r pc + r^2 cc.
double half_width_by_trial(const LagSums& sums, double r, double alpha) {
    const double squares = std::max(0.0, sums.pp - 2 * r * sums.pc + r * r * sums.cc);
    const double mean_count = sums.c / sums.trials;
    return t_quantile(alpha, sums.trials - 1) * std::sqrt(squares / (sums.trials - 1) / sums.trials) / mean_count;
}

}  // namespace

void LagSums::add(double sum, double count, double squares) {
    if (!(count > 0)) return;
    ++trials;
    p += sum;
    pp += sum * sum;
    pc += sum * count;
    c += count;
    cc += count * count;
    product_squares += squares;
}

std::optional<LagCorrelation> correlation_of(const LagSums& sums, double alpha) {
    if (!(sums.c >= least_products)) return std::nullopt;
    const double r = sums.p / sums.c;
    double half = 0;
    if (sums.trials < enough_trials_for_spread)
        half = normal_quantile(alpha) * std::sqrt(sums.product_squares) / sums.c;
    if (sums.trials >= 2) half = std::max(half, half_width_by_trial(sums, r, alpha));
    return LagCorrelation{r, {r - half, r + half}};
}

}  // namespace credence
