#include <credence/detail/exact_moments.hpp>

#include "base/nan.hpp"
#include "numeric/superaccumulator.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// a b exactly: the rounded product, and its rounding error.
template <class Sum>
void add_product(Sum& sum, double a, double b) {
    const double product = a * b;
    sum.add(product);
    if (const double error = std::fma(a, b, -product); error != 0) sum.add(error);
}

/// n Q - S^2
double spread_of(const ExactMoments& values) {
    ExactSum spread;
    for (const double part : values.square_sum.parts()) add_product(spread, static_cast<double>(values.count), part);
    const std::vector<double> sum = values.sum.parts();
    for (const double a : sum)
        for (const double b : sum) add_product(spread, -a, b);
    return spread.rounded();
}

}  // namespace

void ExactMoments::add(const ExactMoments& other, int sign) {
    count += sign * other.count;
    sum.add(other.sum, sign);
    square_sum.add(other.square_sum, sign);
}

ExactMoments exact_moments(const std::vector<double>& values) {
    constexpr std::size_t at_once = 1024;  // a superaccumulator takes no more
    ExactMoments moments;
    for (std::size_t first = 0; first < values.size(); first += at_once) {
        Superaccumulator sums;
        for (std::size_t i = first; i < std::min(values.size(), first + at_once); ++i) {
            if (std::isnan(values[i])) continue;
            ++moments.count;
            sums.add(values[i]);
        }
        moments.sum.add(sums.sum());
        moments.square_sum.add(sums.square_sum());
    }
    return moments;
}

Moments moments_of(const ExactMoments& values) {
    const auto n = static_cast<double>(values.count);
    if (values.count < 1) return {n, nan, nan, nan};
    double mean = values.sum.rounded() / n;
    // Two roundings may miss the mean, even that of equal values: what they left is added.
    ExactSum left = values.sum;
    add_product(left, -n, mean);
    mean += left.rounded() / n;
    if (values.count < 2) return {n, mean, nan, nan};
    // No values have a spread below 0: if a damaged file gives one, it must not appear as certainty.
    const double variance = spread_of(values) / n / (n - 1);
    return {n, mean, std::sqrt(variance), std::sqrt(variance / n)};
}

void DifferenceTotals::add(const DifferenceTotals& other, int sign) {
    difference.add(other.difference, sign);
    below += sign * other.below;
    above += sign * other.above;
}

DifferenceTotals DifferenceTotals::reversed() const {
    DifferenceTotals other{{difference.count, {}, difference.square_sum}, above, below};
    other.difference.sum.add(difference.sum, -1);
    return other;
}

DifferenceTotals differences_of(const std::vector<double>& a, const std::vector<double>& b) {
    DifferenceTotals totals;
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        differences[i] = a[i] - b[i];
        totals.below += a[i] < b[i];
        totals.above += a[i] > b[i];
    }
    totals.difference = exact_moments(differences);
    return totals;
}

}  // namespace credence
