// Paired comparison of two arms, against SciPy and NumPy, and by replication.

#include <credence/detail/paired.hpp>

#include "reference.hpp"
#include "synthetic.hpp"

namespace credence::test::paired_test {

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

/// `count` pairs c + u, c + v: c normal with standard deviation `common`, u and v standard normal.
struct Pairs {
    std::vector<double> a, b;

    Pairs(Normals& normals, int count, double common) {
        for (int i = 0; i < count; ++i) {
            const double shared = common * normals();
            a.push_back(shared + normals());
            b.push_back(shared + normals());
        }
    }
};

}  // namespace

TEST_CASE("paired: every number agrees with SciPy and NumPy") {
    // With failed trials; with many zero differences and ties; with three pairs; with all differences of one sign.
    for (const Json& one : reference("paired")) {
        const PairedComparison c = compare_paired(numbers(one["a"]), numbers(one["b"]), 99, "paired");
        CHECK(c.pairs == one["pairs"]);
        check_agrees(c.difference.mean, one["mean"]);
        check_agrees(c.difference.ci95, one["ci95"]);
        check_agrees(c.difference.median, one["median"]);
        check_agrees(c.bootstrap95, one["bootstrap95"]);
        check_agrees(c.wins_a, one["wins_a"]);
        check_agrees(c.wins_b, one["wins_b"]);
        check_agrees(c.ties, one["ties"]);
        check_agrees(c.sign_p, one["sign_p"]);
        check_agrees(c.wilcoxon_z, one["wilcoxon_z"]);
        check_agrees(c.wilcoxon_p, one["wilcoxon_p"]);
        check_agrees(c.effect_size, one["effect_size"]);
        check_agrees(c.variance_reduction, one["variance_reduction"]);
    }
}

TEST_CASE("paired: Fisher's exact test agrees with SciPy, and comes to an end for any number of trials") {
    for (const Json& one : reference("fisher"))
        check_agrees(fisher_exact(one[0], one[1], one[2], one[3]), one[4]);
    constexpr std::int64_t many = 1'000'000'000'000;
    CHECK(fisher_exact(many / 2, many, many / 4, many) == 0);
    CHECK(fisher_exact(many / 2, many, many / 2, many) == 1);
}

TEST_CASE("paired: where mean and median differ in sign, the fewest pairs that carry the mean are named") {
    const auto carrying = [](const std::vector<double>& a) {
        return compare_paired(a, std::vector<double>(a.size(), 0), 1, "f").carrying;
    };
    // The sum is 2.5; without the 5, -2.5.
    CHECK(carrying({-1, missing, 4, -1, 5, -1.5, -1.5, -1.5}).first == std::vector<std::int64_t>{4});
    CHECK(carrying({1, 1, 1, -1, -8}).count == 1);
    CHECK(carrying({1, 1, 4, -1, -1}).count == 0);
    CHECK(carrying({-1, -1, -1, -1, -1, -1, -1, -1, -1, 3, 3, 2, 3, 2, 3, 3}).count == 4);  // 3 3 3 3, with 10 > 9
}

TEST_CASE("paired: the smaller value wins, and its arm has the negative score") {
    const PairedComparison c = compare_paired({1, 1, 1, 5}, {2, 3, 1, 4}, 1, "f");
    CHECK(c.wins_a == 0.5);
    CHECK(c.wins_b == 0.25);
    CHECK(c.ties == 0.25);
    CHECK(c.difference.mean == -0.5);
    CHECK(c.wilcoxon_z < 0);
    // Differences -1, -2, 1: ranks 1.5, 3, 1.5; W = 1.5, 3 expected, variance 3.5 - 6/48.
    check_agrees(c.wilcoxon_z, -1.5 / std::sqrt(3.375));
}

TEST_CASE("paired: arms that never differ tie, and no test rejects") {
    const PairedComparison c = compare_paired({1, 2, 4}, {1, 2, 4}, 1, "f");
    CHECK(c.ties == 1);
    CHECK(c.difference.mean == 0);
    CHECK(c.bootstrap95.low == 0);
    CHECK(c.bootstrap95.high == 0);
    CHECK(std::isnan(c.wilcoxon_z));
    CHECK(c.wilcoxon_p == 1);
    CHECK(std::isnan(c.effect_size));
    CHECK(std::isinf(c.variance_reduction));
    const PairedComparison shifted = compare_paired({2, 3, 5}, {1, 2, 4}, 1, "f");
    CHECK(std::isinf(shifted.effect_size));
    CHECK(std::isinf(shifted.variance_reduction));
}

TEST_CASE("paired: values that are both infinite are no pair, and the ranks come to an end") {
    const double infinite = std::numeric_limits<double>::infinity();
    const PairedComparison comparison =
        compare_paired({infinite, 1, -infinite, 2}, {infinite, 3, -infinite, 5}, 1, "x");
    CHECK(comparison.pairs == 2);
    CHECK(comparison.difference.mean == -2.5);
    CHECK(comparison.wins_a == 1);
}

TEST_CASE("paired: without pairs everything is NaN, with one all but its difference and signs") {
    const PairedComparison none = compare_paired({1, missing}, {missing, 2}, 1, "f");
    CHECK(none.pairs == 0);
    for (const double figure : {none.difference.mean, none.bootstrap95.low, none.wins_a, none.ties, none.wilcoxon_z,
                                none.wilcoxon_p, none.effect_size, none.variance_reduction})
        CHECK(std::isnan(figure));
    const PairedComparison single = compare_paired({1, 7}, {3}, 1, "f");
    CHECK(single.pairs == 1);
    CHECK(single.difference.mean == -2);
    CHECK(single.wins_a == 1);
    CHECK(std::isnan(single.difference.ci95.low));
    CHECK(std::isnan(single.effect_size));
    CHECK(std::isnan(single.variance_reduction));
}

TEST_CASE("paired: Holm adjusts as worked by hand") {
    const auto check = [](const std::vector<double>& p, const std::vector<double>& expected) {
        const std::vector<double> adjusted = holm(p);
        REQUIRE(adjusted.size() == expected.size());
        for (std::size_t i = 0; i < p.size(); ++i) check_agrees(adjusted[i], expected[i]);
    };
    check({}, {});
    check({0.03}, {0.03});
    // Sorted 0.005, 0.01, 0.03, 0.04 times 4, 3, 2, 1: 0.02, 0.03, 0.06, 0.04, which may not fall: 0.06.
    check({0.01, 0.04, 0.03, 0.005}, {0.03, 0.06, 0.06, 0.02});
    check({0.01, missing, 0.04, 0.03, 0.005, missing}, {0.03, missing, 0.06, 0.06, 0.02, missing});
    check({0.6, 0.5, 1.0}, {1, 1, 1});
    check({0.02, 0.02}, {0.04, 0.04});
    check({0.0, 0.02, 0.05}, {0, 0.04, 0.05});
}

TEST_CASE("paired: under the null, t and signed ranks reject at their level", "[long]") {
    // 2,000 replications of 30 pairs. The t test's level is exactly 5 %; the score's is what all 2^30 signs give, 4.97
    // %. Each count is beyond 4 standard deviations with 6e-5; the 90 % interval, of alpha in each tail, would be 10
    // off.
    constexpr int replications = 2000, count = 30;
    const Json& exact = reference("wilcoxon_level");
    REQUIRE(exact["pairs"] == count);
    Normals normals(41);
    int t_rejects = 0, ranks_reject = 0;
    for (int r = 0; r < replications; ++r) {
        const Pairs pairs(normals, count, 2);
        const PairedComparison c = compare_paired(pairs.a, pairs.b, 1, "null");
        t_rejects += c.difference.ci95.low > 0 || c.difference.ci95.high < 0;
        ranks_reject += c.wilcoxon_p <= 0.05;
    }
    CAPTURE(t_rejects, ranks_reject);
    CHECK(within_binomial(t_rejects, replications, 0.05));
    CHECK(within_binomial(ranks_reject, replications, exact["level"]));
}

TEST_CASE("paired: an arm that is better by half a standard deviation is found") {
    // 200 pairs, d_z = -0.5: expected are a score of -6.4, with standard deviation 0.9; d_z -0.5 with 0.075; a mean of
    // 7.1 standard errors; a share of 69 % with 3.3 %. Each bound is at least 4 standard deviations off: 3e-5, five
    // times.
    Normals normals(43);
    Pairs pairs(normals, 200, 3);
    for (double& value : pairs.a) value -= 0.5 * std::sqrt(2.0);
    const PairedComparison c = compare_paired(pairs.a, pairs.b, 1, "better");
    CHECK(c.difference.ci95.high < 0);
    CHECK(c.bootstrap95.high < 0);
    CHECK(c.wilcoxon_z < -2.4);
    CHECK(c.effect_size < -0.2);
    CHECK(c.wins_a > c.wins_b);
}

TEST_CASE("paired: the variance reduction of correlated pairs is the known one") {
    // V_A = V_B = s^2 + 1 and V_{A-B} = 2: the factor is s^2 + 1. For normal pairs of one variance a + b and a - b are
    // independent, so that the estimate is (1 + r F)/2 with r = 2 s^2 + 1 and F Fisher's of (n - 1, n - 1) degrees:
    // E F = (n-1)/(n-3), var F = 4 (n-1)^2 (n-2) / ((n-1) (n-3)^2 (n-5)). The mean of the replications is beyond 4
    // standard errors with 6e-5.
    constexpr int replications = 100, count = 100;
    constexpr double s = 3, r = 2 * s * s + 1, d = count - 1;
    Normals normals(47);
    double sum = 0;
    for (int i = 0; i < replications; ++i) {
        const Pairs pairs(normals, count, s);
        sum += compare_paired(pairs.a, pairs.b, 1, "reduction").variance_reduction;
    }
    const double expected = 0.5 * (1 + r * d / (d - 2));
    const double deviation = 0.5 * r * std::sqrt(2 * d * d * (2 * d - 2) / (d * (d - 2) * (d - 2) * (d - 4)));
    CHECK(std::abs(sum / replications - expected) < 4 * deviation / std::sqrt(double{replications}));
    CHECK(std::abs(expected - (s * s + 1)) < 0.25);
}

}  // namespace credence::test::paired_test
