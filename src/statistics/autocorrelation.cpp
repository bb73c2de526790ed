#include "statistics/autocorrelation.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>

namespace credence {

namespace {

/// The sums over k of x_k x_{k+l}, by lag l from 0 on, by Fourier transform: a series that decorrelates slowly has many
/// lags. Zeros behind the series keep its end apart from its start.
std::vector<double> lagged_products(const std::vector<double>& values, double mean) {
    std::vector<double> products(std::bit_ceil(2 * values.size()), 0.0);
    std::ranges::transform(values, products.begin(), [&](double value) { return value - mean; });
    std::vector<std::complex<double>> spectrum;
    Eigen::FFT<double> transform;
    transform.fwd(spectrum, products);
    for (std::complex<double>& one : spectrum) one = std::norm(one);
    transform.inv(products, spectrum);
    return products;
}

}  // namespace

Autocorrelation autocorrelation(const std::vector<double>& values, double mean) {
    constexpr double of_time = 5;
    Autocorrelation found;
    if (std::ranges::all_of(values, [&](double value) { return value == mean; })) return found;
    const std::vector<double> products = lagged_products(values, mean);
    double time = 0.5;
    for (std::size_t lag = 0; lag <= values.size() / 2; ++lag) {
        found.by_lag.push_back(products[lag] / products[0]);
        if (lag == 0 || found.window > 0) continue;
        time += found.by_lag.back();
        if (static_cast<double>(lag) >= of_time * time) found.window = lag;
    }
    found.time = found.window > 0 ? std::max(time, 0.5) : std::numeric_limits<double>::infinity();
    return found;
}

double independent_steps(double autocorrelation_time) { return std::ceil(10 * autocorrelation_time); }

double f_upper_quantile(double p, double above, double below) {
    return quantile(complement(boost::math::fisher_f(above, below), p));
}

}  // namespace credence
