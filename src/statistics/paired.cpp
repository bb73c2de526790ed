#include <algorithm>
#include <cmath>
#include <functional>
#include "statistics/bootstrap.hpp"
#include <credence/detail/paired.hpp>

#include "base/nan.hpp"
#include <boost/math/distributions/binomial.hpp>
#include <utility>

namespace credence {

namespace {

/// Sum of the ranks of positive differences, and sum of t^3 - t over groups of t differences of one size.
struct RankSums {
    double positive = 0, ties = 0;
};

/// `differences` in increasing order of size, none of them 0.
RankSums rank_sums(const std::vector<double>& differences) {
    RankSums sums;
    for (std::size_t first = 0; first < differences.size();) {
        std::size_t last = first;
        double positive = 0;
        for (; last < differences.size() && std::abs(differences[last]) == std::abs(differences[first]); ++last)
            positive += differences[last] > 0;
        const double t = static_cast<double>(last - first);
        sums.positive += positive * 0.5 * static_cast<double>(first + 1 + last);  // ranks first + 1 ... last
        sums.ties += t * t * t - t;
        first = last;
    }
    return sums;
}

void test_signed_ranks(std::vector<double> differences, PairedComparison& comparison) {
    comparison.wilcoxon_z = nan;
    comparison.wilcoxon_p = differences.empty() ? nan : 1;
    std::erase(differences, 0.0);
    if (differences.empty()) return;
    std::sort(differences.begin(), differences.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
    const RankSums sums = rank_sums(differences);
    const double n = static_cast<double>(differences.size());
    const double variance = n * (n + 1) * (2 * n + 1) / 24 - sums.ties / 48;
    comparison.wilcoxon_z = (sums.positive - n * (n + 1) / 4) / std::sqrt(variance);
    comparison.wilcoxon_p = std::erfc(std::abs(comparison.wilcoxon_z) / std::sqrt(2.0));
}

/// `differences` by pair, NaN where there is none.
CarryingPairs carrying_pairs(const std::vector<double>& differences, const Summary& difference) {
    if (!(difference.mean * difference.median < 0)) return {};
    const double sign = difference.mean < 0 ? -1 : 1;
    std::vector<std::int64_t> order;
    for (std::size_t i = 0; i < differences.size(); ++i)
        if (sign * differences[i] > 0) order.push_back(static_cast<std::int64_t>(i));
    const auto size = [&](std::int64_t i) { return sign * differences[static_cast<std::size_t>(i)]; };
    std::ranges::stable_sort(order, std::greater(), size);
    double rest = sign * difference.mean * static_cast<double>(difference.count);
    CarryingPairs carrying;
    for (auto largest = order.begin(); rest > 0 && largest != order.end(); ++largest, ++carrying.count)
        rest -= size(*largest);
    order.resize(static_cast<std::size_t>(std::min<std::int64_t>(carrying.count, 5)));
    carrying.first = std::move(order);
    return carrying;
}

}  // namespace

double sign_test(std::int64_t below, std::int64_t above) {
    if (below + above == 0) return 1;
    const boost::math::binomial half(static_cast<double>(below + above), 0.5);
    return std::min(1.0, 2 * cdf(half, static_cast<double>(std::min(below, above))));
}

double fisher_exact(std::int64_t a, std::int64_t of_a, std::int64_t b, std::int64_t of_b) {
    const double both = static_cast<double>(a + b), A = static_cast<double>(of_a), B = static_cast<double>(of_b);
    double all = 1, rare = 1;  // sums of probabilities relative to that of the table that was seen
    for (const int step : {1, -1}) {
        double weight = 1, k = static_cast<double>(step > 0 ? a : a - 1);
        for (; weight > 1e-20 && std::isfinite(all); k += step) {
            const double ratio = (A - k) * (both - k) / ((k + 1) * (B - both + k + 1));  // of k + 1 to k
            weight *= step > 0 ? ratio : 1 / ratio;
            all += weight;
            if (weight <= 1 + 1e-7) rare += weight;
        }
    }
    return std::min(1.0, rare / all);
}

PairedComparison compare_paired(const std::vector<double>& a, const std::vector<double>& b, std::uint64_t root_seed,
                                const std::string& column) {
    std::vector<double> differences, paired_a, paired_b;
    std::vector<double> by_trial(std::min(a.size(), b.size()), nan);  // the bootstrap resamples blocks by trial
    for (std::size_t i = 0; i < by_trial.size(); ++i) {
        if (std::isnan(a[i] - b[i])) continue;  // also where both are infinite
        by_trial[i] = a[i] - b[i];
        differences.push_back(by_trial[i]);
        paired_a.push_back(a[i]);
        paired_b.push_back(b[i]);
    }
    PairedComparison comparison =
        compare_totals(differences_of(paired_a, paired_b), exact_moments(paired_a), exact_moments(paired_b));
    comparison.bootstrap95 = bootstrap_mean_interval(by_trial, root_seed, column);
    test_signed_ranks(differences, comparison);
    comparison.histogram = histogram(differences, BinWidths::equal);
    comparison.difference.median = quantile(differences, 0.5);
    comparison.carrying = carrying_pairs(by_trial, comparison.difference);
    return comparison;
}

PairedComparison compare_totals(const DifferenceTotals& totals, const ExactMoments& a, const ExactMoments& b) {
    PairedComparison comparison;
    const std::int64_t pairs = comparison.pairs = totals.difference.count;
    comparison.difference = summary_of(moments_of(totals.difference));
    comparison.bootstrap95 = {nan, nan};
    comparison.wilcoxon_z = comparison.wilcoxon_p = comparison.variance_reduction = nan;
    comparison.wins_a = static_cast<double>(totals.below) / static_cast<double>(pairs);
    comparison.wins_b = static_cast<double>(totals.above) / static_cast<double>(pairs);
    comparison.ties = static_cast<double>(pairs - totals.below - totals.above) / static_cast<double>(pairs);
    comparison.sign_p = pairs == 0 ? nan : sign_test(totals.below, totals.above);
    const Moments of_a = moments_of(a), of_b = moments_of(b);
    const double deviation = comparison.difference.standard_deviation;
    comparison.effect_size = comparison.difference.mean / deviation;
    comparison.mean_a = comparison.mean_b = nan;
    if (a.count != pairs || b.count != pairs) return comparison;
    comparison.mean_a = of_a.mean;
    comparison.mean_b = of_b.mean;
    comparison.variance_reduction = (of_a.standard_deviation * of_a.standard_deviation +
                                     of_b.standard_deviation * of_b.standard_deviation) /
                                    (deviation * deviation);
    return comparison;
}

std::vector<double> holm(std::vector<double> p) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!std::isnan(p[i])) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
    double largest = 0;
    for (std::size_t j = 0; j < order.size(); ++j) {
        largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - j) * p[order[j]]));
        p[order[j]] = largest;
    }
    return p;
}

}  // namespace credence
