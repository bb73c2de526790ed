#include "statistics/tails.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace credence {

namespace {

/// So many percent of n, rounded up.
std::size_t percent_of(std::size_t n, std::size_t percent) { return (n * percent + 99) / 100; }

}  // namespace

Tail tail_of(std::vector<double> values) {
    constexpr std::size_t enough = 200;
    std::sort(values.begin(), values.end(), std::greater<>());
    const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
    Tail tail;
    tail.worst_share = std::accumulate(values.begin(), at(percent_of(values.size(), 1)), 0.0) /
                       std::accumulate(values.begin(), values.end(), 0.0);
    if (values.size() < enough) return tail;
    const std::size_t k = std::max<std::size_t>(10, percent_of(values.size(), 5));
    double logarithms = 0;
    for (std::size_t i = 0; i < k; ++i) logarithms += std::log(values[i] / values[k]);
    // The index of the squares is half that of the errors.
    if (const double degrees = 2 * static_cast<double>(k) / logarithms; degrees < 10) tail.degrees = degrees;
    return tail;
}

}  // namespace credence
