#include <credence/statistics.hpp>

#include <credence/detail/exact_moments.hpp>

#include "base/nan.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace credence {

namespace {

/// Beyond so many degrees Boost's series end without an answer; a thousand million trials have more.
constexpr double many_degrees = 1e10;

/// The quantile of chi-square with many degrees where the normal distribution has z: the expansion of Cornish and
/// Fisher [Fisher, Cornish 1960], whose next term is below rounding.
double expanded_quantile(double z, double degrees) {
    const double zz = z * z, root = std::sqrt(degrees);
    return degrees + z * std::sqrt(2.0) * root + 2 * (zz - 1) / 3 + z * (zz - 7) / (9 * std::sqrt(2.0) * root);
}

}  // namespace

double t_quantile(double alpha, double degrees) {
    if (!(degrees > 0)) return std::numeric_limits<double>::infinity();
    return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees), alpha / 2));
}

double normal_quantile(double alpha) {
    return boost::math::quantile(boost::math::complement(boost::math::normal(), alpha / 2));
}

double chi_square_quantile(double p, double degrees) {
    if (degrees > many_degrees) return expanded_quantile(boost::math::quantile(boost::math::normal(), p), degrees);
    return boost::math::quantile(boost::math::chi_squared(degrees), p);
}

double chi_square_upper_quantile(double p, double degrees) {
    if (degrees > many_degrees) return expanded_quantile(-boost::math::quantile(boost::math::normal(), p), degrees);
    return boost::math::quantile(boost::math::complement(boost::math::chi_squared(degrees), p));
}

Summary summarise(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    Summary summary = summary_of(moments_of(exact_moments(values)));
    summary.median = quantile(values, 0.5);
    return summary;
}

double quantile(std::vector<double>& values, double p) {
    if (values.empty()) return nan;
    const double place = p * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), values.begin() + below, values.end());
    const double low = values[static_cast<std::size_t>(below)];
    if (below + 1 == static_cast<std::ptrdiff_t>(values.size())) return low;
    const double high = *std::min_element(values.begin() + below + 1, values.end());
    return low + (place - static_cast<double>(below)) * (high - low);
}

double percentile_of(const std::vector<double>& values, double x) {
    std::int64_t count = 0, below = 0, equal = 0;
    for (const double value : values) {
        count += !std::isnan(value);
        below += value < x;
        equal += value == x;
    }
    return count == 0
               ? nan
               : 100 * (static_cast<double>(below) + 0.5 * static_cast<double>(equal)) / static_cast<double>(count);
}

Moments moments_from_sums(std::int64_t count, double sum, double square_sum) {
    const double n = static_cast<double>(count);
    if (count < 1) return {n, nan, nan, nan};
    const double mean = sum / n;
    if (count < 2) return {n, mean, nan, nan};
    const double variance = std::max(0.0, (square_sum - sum * mean) / (n - 1));
    return {n, mean, std::sqrt(variance), std::sqrt(variance / n)};
}

Summary summary_of(const Moments& moments) {
    return {static_cast<std::int64_t>(moments.count), moments.mean, moments.standard_error, t_interval(moments), nan,
            moments.standard_deviation};
}

Interval t_interval(const Moments& moments, double alpha) {
    const double half = t_quantile(alpha, moments.count - 1) * moments.standard_error;
    return {moments.mean - half, moments.mean + half};
}

double t_test(const Moments& moments, double expected) {
    if (!(moments.count > 1) || !(moments.standard_error > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double t = std::abs(moments.mean - expected) / moments.standard_error;
    if (!std::isfinite(t)) return 0;
    return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(moments.count - 1), t));
}

}  // namespace credence
