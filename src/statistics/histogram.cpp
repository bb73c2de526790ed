#include <credence/detail/histogram.hpp>

#include <credence/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace credence {

namespace {

constexpr double bins_of_decade = 24, tail = 0.001;
constexpr std::size_t most_bins = 400;

bool all_whole(const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return value == std::nearbyint(value); });
}

/// The round width nearest above: 1, 2 or 5 times a power of ten.
double round_width(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

/// The integers first, first + 1 ... last, converted to edges.
template <class Edge>
std::vector<double> edges_of(double first, double last, const Edge& edge) {
    std::vector<double> edges;
    for (double i = first; i <= last && edges.size() <= most_bins; ++i) edges.push_back(edge(i));
    return edges;
}

std::vector<double> equal_edges(double low, double high, int about, bool whole) {
    const double spread =
                     high > low ? std::max(high - low, 1e-12 * std::abs(high)) : std::max(1e-6, std::abs(high) / 1000),
                 width = whole ? std::max(1.0, round_width(spread / about)) : round_width(spread / about),
                 shift = whole ? -0.5 : 0;
    return edges_of(std::floor((low - shift) / width), std::floor((high - shift) / width) + 1,
                    [&](double i) { return i * width + shift; });
}

std::vector<double> ratio_edges(double low, double high) {
    return edges_of(std::floor(std::log10(low) * bins_of_decade), std::floor(std::log10(high) * bins_of_decade) + 1,
                    [&](double i) { return std::pow(10, i / bins_of_decade); });
}

}  // namespace

std::int64_t Histogram::total() const { return std::accumulate(counts.begin(), counts.end(), below + above); }

Histogram histogram(std::vector<double>& values, BinWidths widths, int about) {
    Histogram histogram;
    const double low = quantile(values, tail), high = quantile(values, 1 - tail);
    if (!std::isfinite(low) || !std::isfinite(high)) return histogram;
    if (low > 0) histogram.widths = widths;
    histogram.edges = histogram.widths == BinWidths::ratio ? ratio_edges(low, high)
                                                           : equal_edges(low, high, about, all_whole(values));
    histogram.counts.resize(histogram.edges.size() - 1);
    for (const double value : values) {
        const auto edge = std::upper_bound(histogram.edges.begin(), histogram.edges.end(), value);
        if (edge == histogram.edges.begin())
            ++histogram.below;
        else if (edge == histogram.edges.end())
            ++histogram.above;
        else
            ++histogram.counts[static_cast<std::size_t>(edge - histogram.edges.begin() - 1)];
    }
    return histogram;
}

}  // namespace credence
