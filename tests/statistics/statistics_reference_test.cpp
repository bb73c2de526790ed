// Quantiles and statistics of samples, against SciPy and NumPy (tests/reference/make_statistics.py).

#include "reference.hpp"

namespace credence::test::statistics_reference_test {

using Catch::Matchers::WithinAbs;

TEST_CASE("statistics: t and normal quantiles agree with SciPy, alpha being that of both tails") {
    for (const Json& row : reference("t_quantile")) check_agrees(t_quantile(row[0], row[1]), row[2]);
    for (const Json& row : reference("normal_quantile")) check_agrees(normal_quantile(row[0]), row[1]);
    // Alpha in each tail, a known mistake, would give scipy.stats.norm.ppf(0.95) = 1.645, t.ppf(0.95, 9) = 1.833.
    CHECK(normal_quantile(0.05) > 1.95);
    CHECK(t_quantile(0.05, 9) > 2.26);
}

TEST_CASE("statistics: chi-square quantiles agree with SciPy") {
    for (const Json& row : reference("chi_square_quantile")) check_agrees(chi_square_quantile(row[0], row[1]), row[2]);
    for (const Json& row : reference("chi_square_upper_quantile"))
        check_agrees(chi_square_upper_quantile(row[0], row[1]), row[2]);
}

TEST_CASE("statistics: chi-square quantiles of a thousand million trials' degrees have an answer") {
    for (const Json& row : reference("standardised_chi_square")) {
        const double degrees = row[1], deviation = std::sqrt(2 * degrees);
        CHECK_THAT((chi_square_quantile(row[0], degrees) - degrees) / deviation, WithinAbs(row[2], 1e-8));
        CHECK_THAT((chi_square_upper_quantile(row[0], degrees) - degrees) / deviation, WithinAbs(row[3], 1e-8));
    }
}

TEST_CASE("statistics: statistics of samples agree with NumPy and SciPy") {
    for (const Json& sample : reference("samples")) {
        const std::vector<double> values = numbers(sample["values"]);
        const Summary summary = summarise(values);
        CHECK(summary.count == static_cast<std::int64_t>(values.size()));
        check_agrees(summary.mean, sample["mean"], 1e-15);
        check_agrees(summary.standard_deviation, sample["standard_deviation"]);
        check_agrees(summary.standard_error, sample["standard_error"]);
        check_agrees(summary.ci95, sample["ci95"]);
        check_agrees(summary.median, sample["median"], 1e-15);
        for (const Json& row : sample["quantiles"]) {
            std::vector<double> copy = values;
            check_agrees(quantile(copy, row[0]), row[1]);
        }
        for (const Json& row : sample["percentiles"]) check_agrees(percentile_of(values, row[0]), row[1]);
    }
}

TEST_CASE("statistics: a 99th percentile is one, not the mean and 2.33 standard deviations") {
    // The sample is chi-square of 2 degrees at equal steps of probability: 8.4 against 6.6.
    std::vector<double> values = numbers(reference("samples")[3]["values"]);
    const Summary summary = summarise(values);
    const double percentile = quantile(values, 0.99);
    CHECK(percentile > summary.mean + 3 * summary.standard_deviation);
    int below = 0;
    for (const double value : values) below += value < percentile;
    CHECK(below == 99);  // of 101; below the mean and 2.33 sd are 97
}

}  // namespace credence::test::statistics_reference_test
