// Figures of samples, against values computed by SciPy 1.10 and NumPy 1.24.

#include "catch.hpp"

#include <credence/statistics.hpp>

#include <cmath>
#include <limits>

namespace credence::test::statistics_test {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {
const double missing = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> sample{3.25, -1.5, 7.125, 0.0, 2.0, 2.0, 11.75, -4.0};
}  // namespace

TEST_CASE("statistics: quantiles of Student's t and the normal agree with SciPy") {
    // scipy.stats.t.ppf(1 - alpha/2, df), scipy.stats.norm.ppf(1 - alpha/2)
    CHECK_THAT(t_quantile(0.05, 1), WithinRel(12.706204736432095, 1e-9));
    CHECK_THAT(t_quantile(0.05, 9), WithinRel(2.2621571627409915, 1e-9));
    CHECK_THAT(t_quantile(0.05, 255), WithinRel(1.9693105698491928, 1e-9));
    CHECK_THAT(t_quantile(0.05, 9999), WithinRel(1.9602012636213575, 1e-9));
    CHECK_THAT(normal_quantile(0.05), WithinRel(1.959963984540054, 1e-9));
    CHECK_THAT(normal_quantile(0.01), WithinRel(2.5758293035489004, 1e-9));
    CHECK(std::isinf(t_quantile(0.05, 0)));
}

TEST_CASE("statistics: a summary agrees with NumPy and SciPy") {
    const Summary s = summarise(sample);
    CHECK(s.count == 8);
    CHECK_THAT(s.mean, WithinRel(2.578125, 1e-14));
    CHECK_THAT(s.standard_deviation, WithinRel(4.963679465808173, 1e-12));
    CHECK_THAT(s.standard_error, WithinRel(1.7549257049546894, 1e-12));
    CHECK_THAT(s.ci95.low, WithinRel(-1.5716148806572035, 1e-9));
    CHECK_THAT(s.ci95.high, WithinRel(6.7278648806572035, 1e-9));
    CHECK(s.median == 2.0);
}

TEST_CASE("statistics: NaN values are left out of a summary, and too few values give NaN") {
    std::vector<double> values = sample;
    values.push_back(missing);
    CHECK(summarise(values).count == 8);
    CHECK(summarise(values).mean == summarise(sample).mean);
    CHECK(std::isnan(summarise({}).mean));
    CHECK(summarise({4.0}).mean == 4.0);
    CHECK(summarise({4.0}).median == 4.0);
    CHECK(std::isnan(summarise({4.0}).standard_error));
    CHECK(std::isnan(summarise({4.0}).ci95.low));
}

TEST_CASE("statistics: quantiles are of type 7") {
    // numpy.quantile, its default method
    const double p[] = {0, 0.1, 0.25, 0.5, 0.9, 1}, expected[] = {-4.0, -2.25, -0.375, 2.0, 8.5125, 11.75};
    for (int i = 0; i < 6; ++i) {
        std::vector<double> values = sample;
        CHECK_THAT(quantile(values, p[i]), WithinAbs(expected[i], 1e-14));
    }
    std::vector<double> none;
    CHECK(std::isnan(quantile(none, 0.5)));
}

TEST_CASE("statistics: percentile is the mid-rank") {
    // scipy.stats.percentileofscore(kind='mean')
    CHECK(percentile_of(sample, 2.0) == 50.0);
    CHECK(percentile_of(sample, -10) == 0.0);
    CHECK(percentile_of(sample, 12) == 100.0);
    CHECK(percentile_of(sample, 0.5) == 37.5);
    CHECK(percentile_of(sample, 3.25) == 68.75);
    CHECK(percentile_of({1, missing, 3}, 2) == 50.0);
    CHECK(std::isnan(percentile_of({missing}, 2)));
}

TEST_CASE("statistics: the mean of equal values is their value, and they have no spread") {
    for (const int count : {2, 3, 7, 49, 1000}) {
        const Summary summary = summarise(std::vector<double>(static_cast<std::size_t>(count), 0.1));
        CHECK(summary.mean == 0.1);
        CHECK(summary.standard_deviation == 0);
    }
}

TEST_CASE("statistics: moments from sums are those of the values") {
    double sum = 0, squares = 0;
    for (const double x : sample) sum += x, squares += x * x;
    const Moments m = moments_from_sums(8, sum, squares);
    const Summary s = summarise(sample);
    CHECK_THAT(m.mean, WithinRel(s.mean, 1e-14));
    CHECK_THAT(m.standard_deviation, WithinRel(s.standard_deviation, 1e-12));
    CHECK_THAT(m.standard_error, WithinRel(s.standard_error, 1e-12));
    CHECK(std::isnan(moments_from_sums(1, 2, 4).standard_error));
    CHECK(moments_from_sums(3, 3, 3).standard_deviation == 0.0);  // equal values: rounding must not go below 0
}

}  // namespace credence::test::statistics_test
