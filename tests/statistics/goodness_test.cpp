// Goodness of fit, against SciPy and published values, and by replication.

#include <algorithm>
#include <chrono>
#include "statistics/goodness.hpp"

#include "reference.hpp"
#include "synthetic.hpp"

namespace credence::test::goodness_test {

using Catch::Matchers::WithinAbs;

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> chi_square_values(Normals& normals, int degrees, int count, double scale = 1) {
    std::vector<double> values(static_cast<std::size_t>(count));
    for (double& value : values) value = scale * normals.chi_square(degrees);
    return values;
}

/// The distance of values from chi-square(degrees).
double chi_square_distance(std::vector<double> values, double degrees) {
    for (double& value : values) value = 1 - chi_square_p(value, degrees);
    return uniform_distance(std::move(values));
}

/// Counts in `cells` cells of equal probability under chi-square(degrees).
std::vector<std::int64_t> cell_counts(const std::vector<double>& values, int degrees, int cells) {
    std::vector<std::int64_t> counts(static_cast<std::size_t>(cells));
    for (const double value : values) {
        const int cell = static_cast<int>((1 - chi_square_p(value, degrees)) * cells);
        ++counts[static_cast<std::size_t>(std::min(cell, cells - 1))];
    }
    return counts;
}

/// Of N = trials, the probability of each number of successes.
double binomial(int successes, int trials, double p) {
    return std::exp(std::lgamma(trials + 1) - std::lgamma(successes + 1) - std::lgamma(trials - successes + 1) +
                    successes * std::log(p) + (trials - successes) * std::log1p(-p));
}

}  // namespace

TEST_CASE("goodness: Wilson's interval agrees with SciPy, with none and all successful too") {
    for (const Json& row : reference("wilson")) {
        const Interval interval = wilson_interval(row[0], row[1], row[2]);
        check_agrees(interval.low, row[3]);
        check_agrees(interval.high, row[4]);
    }
    CHECK(wilson_interval(0, 20).low == 0);
    CHECK(wilson_interval(20, 20).high == 1);
    CHECK(std::isnan(wilson_interval(0, 0).low));
    // z of alpha in each tail would give 1.645^2 / (20 + 1.645^2) = 0.119.
    check_agrees(wilson_interval(0, 20).high, 3.841458820694124 / 23.841458820694124);
}

TEST_CASE("goodness: Wilson's interval misses 99 % of 1000 trials as often as docs/statistics.md says") {
    double missed = 0;
    for (int successes = 900; successes <= 1000; ++successes) {  // fewer have 1e-70
        const Interval interval = wilson_interval(successes, 1000);
        if (interval.low > 0.99 || interval.high < 0.99) missed += binomial(successes, 1000, 0.99);
    }
    CHECK_THAT(missed, WithinAbs(0.0365, 5e-5));
}

TEST_CASE("goodness: the chi-square band agrees with SciPy and the published values") {
    for (const Json& row : reference("chi_square_band")) {
        const Interval band = chi_square_band(row[0], row[1]);
        check_agrees(band.low, row[2]);
        check_agrees(band.high, row[3]);
    }
    // docs/statistics.md, with three decimals; alpha in each tail would give 8.04 and 10.01 for N = 50.
    const Interval few = chi_square_band(50 * 9, 0.05), many = chi_square_band(1000 * 9, 0.05);
    CHECK_THAT(9 * few.low, WithinAbs(7.862, 5e-4));
    CHECK_THAT(9 * few.high, WithinAbs(10.213, 5e-4));
    CHECK_THAT(9 * many.low, WithinAbs(8.739, 5e-4));
    CHECK_THAT(9 * many.high, WithinAbs(9.265, 5e-4));
}

TEST_CASE("goodness: chi-square p-values agree with SciPy") {
    for (const Json& row : reference("chi_square_p")) check_agrees(chi_square_p(row[0], row[1]), row[2]);
    CHECK(chi_square_p(-1, 3) == 1);
    CHECK(chi_square_p(HUGE_VAL, 3) == 0);
    CHECK(std::isnan(chi_square_p(missing, 3)));
    CHECK(std::isnan(chi_square_p(1, 0)));
}

TEST_CASE("goodness: distances agree with SciPy, exact and on cells") {
    for (const Json& one : reference("distances")) {
        const std::vector<double> values = numbers(one["values"]);
        const int degrees = one["degrees"];
        const std::vector<std::int64_t> counts = one["counts"];
        const int cells = static_cast<int>(counts.size());
        check_agrees(chi_square_distance(values, degrees), one["distance"]);
        CHECK(cell_counts(values, degrees, cells) == counts);
        check_agrees(cell_distance(counts.data(), cells), one["cell_distance"]);
    }
    CHECK(chi_square_distance({1.5, missing}, 2) == chi_square_distance({1.5}, 2));
    CHECK(std::isnan(chi_square_distance({missing}, 2)));
    const std::int64_t none[] = {0, 0}, all[] = {0, 0, 0, 5};
    CHECK(std::isnan(cell_distance(none, 2)));
    CHECK(cell_distance(all, 4) == 0.75);
}

TEST_CASE("goodness: cells lose at most one over their number of the distance") {
    Normals normals(51);
    for (int r = 0; r < 200; ++r) {
        const std::vector<double> values = chi_square_values(normals, 3, 40, r % 2 ? 1.0 : 1.5);
        const double exact = chi_square_distance(values, 3);
        for (const int cells : {16, 4096}) {
            const double seen = cell_distance(cell_counts(values, 3, cells).data(), cells);
            CHECK(seen <= exact + 1e-12);  // rounding of a probability
            CHECK(seen >= exact - 1.0 / cells - 1e-12);
        }
    }
}

TEST_CASE("goodness: Kolmogorov-Smirnov p-values agree with SciPy") {
    const Json& values = reference("kolmogorov_smirnov");
    for (const Json& row : values["scipy"]) {
        CAPTURE(row);
        check_agrees(kolmogorov_smirnov_p(row[0], row[1]), row[2]);
    }
    // Beyond 10^6 values and n d^2 = 2.2 SciPy takes the first term of an expansion, whose next is 1e-7 of it for 10^9
    // values at these distances: agreement to 1e-9 is with both terms.
    for (const Json& row : values["scipy_large"]) check_agrees(kolmogorov_smirnov_p(row[0], row[1]), row[2], 1e-7);
    for (const Json& row : values["large"]) check_agrees(kolmogorov_smirnov_p(row[0], row[1]), row[2]);
}

TEST_CASE("goodness: Kolmogorov-Smirnov p-values are as exact as their docstring says") {
    for (const Json& row : reference("kolmogorov_smirnov")["exact"]) {
        const double d = row[0], n = row[1], p = row[2];
        CAPTURE(d, n);
        CHECK(std::abs(kolmogorov_smirnov_p(d, n) - p) < (n * d * d > 2.2 ? 2e-6 * p : 0.06 / (n * n)));
    }
}

TEST_CASE("goodness: Kolmogorov-Smirnov p-values at the ends of their range, and where methods meet") {
    CHECK(kolmogorov_smirnov_p(0, 100) == 1);
    CHECK(kolmogorov_smirnov_p(0.5, 1) == 1);
    check_agrees(kolmogorov_smirnov_p(0.75, 1), 0.5);  // one value: P(|U - 1/2| >= 1/4)
    CHECK(kolmogorov_smirnov_p(1, 100) == 0);
    CHECK(std::isnan(kolmogorov_smirnov_p(missing, 100)));
    CHECK(std::isnan(kolmogorov_smirnov_p(0.1, 0)));
    // scipy.stats.kstwobign.isf(0.05), for n without end; 10^12 values shift it by 2e-7 [Pelz and Good].
    CHECK_THAT(kolmogorov_smirnov_p(1.3580986393225505 / std::sqrt(1e12), 1e12), WithinAbs(0.05, 1e-7));
    // Sums of every term below 8192 values and of 256 of them above: the survival function goes on smoothly.
    for (const double z : {1.5, 2.0, 4.0, 8.0}) {
        double p[4];
        for (int i = 0; i < 4; ++i) p[i] = std::log(kolmogorov_smirnov_p(z / std::sqrt(8191.0 + i), 8191.0 + i));
        CHECK_THAT(p[3] - 3 * p[2] + 3 * p[1] - p[0], WithinAbs(0, 1e-10));
    }
}

TEST_CASE("goodness: Kolmogorov-Smirnov p-values take no longer for more values") {
    // A bound that only a sum over all values misses: a sum over 10^9 takes a minute.
    const auto start = std::chrono::steady_clock::now();
    double sum = 0;
    for (const double n : {1e5, 1e6, 1e9, 1e15})
        for (const double z : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) sum += kolmogorov_smirnov_p(z / std::sqrt(n), n);
    CHECK(sum > 0);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
}

TEST_CASE("goodness: p-values of chi-square draws are uniform, exact and on 4096 cells", "[long]") {
    // 1,000 samples of 200 values. sqrt(1000) times the distance of the p-values from uniform is above 2.2 with
    // 2 exp(-2 2.2^2) = 1.2e-4, and the count below 5 % is beyond 4 standard deviations with 6e-5. The distance on
    // cells is at most 1/4096 less, a 290th of what 5 % exceed: its p-values shift up by less than 0.01.
    constexpr int replications = 1000, count = 200, cells = 4096;
    Normals normals(53);
    std::vector<double> p;
    int rejected = 0, rejected_on_cells = 0;
    for (int r = 0; r < replications; ++r) {
        const std::vector<double> values = chi_square_values(normals, 3, count);
        p.push_back(kolmogorov_smirnov_p(chi_square_distance(values, 3), count));
        rejected += p.back() < 0.05;
        const double seen = cell_distance(cell_counts(values, 3, cells).data(), cells);
        rejected_on_cells += kolmogorov_smirnov_p(seen, count) < 0.05;
    }
    std::sort(p.begin(), p.end());
    double greatest = 0;
    for (int i = 0; i < replications; ++i) {
        const double share = p[static_cast<std::size_t>(i)] * replications;
        greatest = std::max({greatest, (i + 1 - share) / replications, (share - i) / replications});
    }
    CAPTURE(greatest, rejected, rejected_on_cells);
    CHECK(greatest * std::sqrt(double{replications}) < 2.2);
    CHECK(within_binomial(rejected, replications, 0.05));
    CHECK(within_binomial(rejected_on_cells, replications, 0.05));
    CHECK(rejected_on_cells <= rejected);
}

TEST_CASE("goodness: values 20 % too large are found not to be chi-square") {
    // The distribution's distance from chi-square(9) is 0.1505. Where it is that, a share of 2,000 values has a
    // standard deviation of 0.0112 at most: below 0.1058, where p is 6e-20, with 3e-5.
    Normals normals(57);
    const std::vector<double> values = chi_square_values(normals, 9, 2000, 1.2);
    CHECK(kolmogorov_smirnov_p(chi_square_distance(values, 9), 2000) < 1e-18);
}

}  // namespace credence::test::goodness_test
