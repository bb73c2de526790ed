// P(D_n >= d) by the methods that Simard and L'Ecuyer [2011] select for n and d. Nomenclature: n values, distance d,
// z = sqrt(n) d.
#include "statistics/goodness.hpp"

#include "base/nan.hpp"

#include <Eigen/Dense>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/log1p.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr double pi = boost::math::double_constants::pi;

double square(double x) { return x * x; }

/// log(n!) less Stirling's formula (n + 1/2) log n - n + log(2 pi) / 2, for n > 0. Its series, from 16 up with an error
/// below 1e-16; below 16 what it lacks costs at most the rounding of log(n!).
double stirling_error(double n) {
    if (n < 16) return std::lgamma(n + 1) - (n + 0.5) * std::log(n) + n - 0.5 * std::log(2 * pi);
    const double r = 1 / (n * n);
    return (1.0 / 12 - r * (1.0 / 360 - r * (1.0 / 1260 - r * (1.0 / 1680 - r / 1188)))) / n;
}

/// log(n! e^n / n^n)
double log_scaled_factorial(double n) { return stirling_error(n) + 0.5 * std::log(2 * pi * n); }

/// Probability that the distribution of the values first falls d below the true one where j of n values are, for any
/// real 0 < j < n (1 - d): C(n, j) d (d + j/n)^(j-1) (1 - d - j/n)^(n-j). As d/q times the binomial probability of j,
/// q = d + j/n, in Loader's form [Fast and Accurate Computation of Binomial Probabilities, 2000]: nothing cancels.
double crossing(double n, double d, double j) {
    const double m = n - j, nd = n * d;
    if (m <= nd) return 0;
    const double exponent = stirling_error(n) - stirling_error(j) - stirling_error(m) +
                            j * boost::math::log1pmx(nd / j) + m * boost::math::log1pmx(-nd / m);
    return d / (d + j / n) * std::sqrt(n / (2 * pi * j * m)) * std::exp(exponent);
}

/// P(D_n^+ >= d) [Smirnov 1944], the sum of `crossing` over j = 0, 1 ... . Over many values it is a smooth function of
/// j that fades at both ends faster than any power, so that the trapezoidal rule is as exact with 256 terms.
double one_sided(double n, double d) {
    constexpr double most_terms = 8192, few_terms = 256;
    const double stride = n > most_terms ? n / few_terms : 1;
    double sum = 0;
    for (double i = 1; i * stride < n * (1 - d); ++i) sum += crossing(n, d, i * stride);
    return std::exp(n * std::log1p(-d)) + stride * sum;
}

/// P(D_n < d), exact [Durbin 1973; Marsaglia, Tsang, Wang 2003]: n!/n^n times the middle of the n-th power of a matrix,
/// here with e^n moved from the one to the other, so that neither overflows.
double durbin(double n, double d) {
    const int k = static_cast<int>(n * d) + 1, m = 2 * k - 1;
    const double h = k - n * d;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(m, m);
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < std::min(m, i + 2); ++j) matrix(i, j) = 1;
    for (int i = 0; i < m; ++i) {
        matrix(i, 0) -= std::pow(h, i + 1);
        matrix(m - 1, i) -= std::pow(h, m - i);
    }
    if (h > 0.5) matrix(m - 1, 0) += std::pow(2 * h - 1, m);
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < std::min(m, i + 2); ++j) matrix(i, j) *= std::exp(-1 - std::lgamma(i - j + 2));
    Eigen::VectorXd column = Eigen::VectorXd::Unit(m, k - 1);
    for (auto power = static_cast<std::int64_t>(n); power > 0; power /= 2) {
        if (power % 2 == 1) column = matrix * column;
        if (power > 1) matrix = matrix * matrix;
    }
    return column(k - 1) * std::exp(log_scaled_factorial(n));
}

/// P(D_n < d) by its first four terms in 1/sqrt(n) [Pelz and Good 1976; Simard and L'Ecuyer 2011, equation 8].
double pelz_good(double n, double d) {
    const double z2 = n * d * d, z = std::sqrt(z2), z4 = z2 * z2, z6 = z4 * z2;
    double k0 = 0, k1 = 0, k2 = 0, k3 = 0, even2 = 0, even3 = 0;
    for (int k = 1; k <= static_cast<int>(16 * z / pi) + 1; ++k) {
        const double a = square(pi * (k - 0.5)), weight = std::exp(-a / (2 * z2));  // odd multiples of pi/2
        const double a2 = a * a, a3 = a2 * a;
        k0 += weight;
        k1 += weight * (a - z2);
        k2 += weight * (6 * z6 + 2 * z4 + (2 * z4 - 5 * z2) * a + (1 - 2 * z2) * a2);
        k3 += weight *
              ((5 - 30 * z2) * a3 + (212 * z4 - 60 * z2) * a2 + (135 * z4 - 96 * z6) * a - 30 * z6 - 90 * z4 * z4);
        const double b = square(pi * k), even_weight = std::exp(-b / (2 * z2));  // multiples of pi
        even2 += even_weight * b;
        even3 += even_weight * (3 * z2 * b - b * b);
    }
    const double root_n = std::sqrt(n);
    const double second = k2 / (72 * z6 * z) - even2 / (36 * z2 * z);
    const double third = k3 / (6480 * z6 * z4) + even3 / (216 * z6);
    return std::sqrt(2 * pi) * (k0 / z + k1 / (6 * z4 * root_n) + second / n + third / (n * root_n));
}

}  // namespace

double kolmogorov_smirnov_p(double distance, double count) {
    const double n = count, d = distance, nd = n * d, z2 = nd * d;
    if (std::isnan(d) || !(n >= 1) || std::isinf(n)) return nan;
    if (nd <= 0.5) return 1;
    if (d >= 1) return 0;
    if (nd <= 1)
        return 1 - std::exp(log_scaled_factorial(n) + n * (std::log(2 * nd - 1) - 1));  // [Ruben, Gambino 1982]
    const bool few = n <= 140;
    // Beyond these, the probability of crossings on both sides, which is then counted twice, is negligible.
    if (d >= 0.5 || z2 > (few ? 4 : 2.2)) return std::min(1.0, 2 * one_sided(n, d));
    // Both limit the matrix: with z^2 below 0.03 the probability is below 1e-17.
    const bool fits = n <= 100000 && n * d * std::sqrt(d) <= 1.4 && z2 > 0.03;
    return std::clamp(1 - (few || fits ? durbin(n, d) : pelz_good(n, d)), 0.0, 1.0);
}

}  // namespace credence
