// Credibility after Li and Zhao, against NumPy, by hand, and on synthetic errors.

#include <credence/detail/credibility.hpp>

#include "reference.hpp"
#include "synthetic.hpp"

namespace credence::test::credibility_test {

using Catch::Matchers::WithinAbs;

namespace {

const double missing = std::numeric_limits<double>::quiet_NaN();

/// `count` errors of three components, normal with standard deviations 1, 2 and 3, and their NEES when told `told`
/// times these.
struct Errors {
    std::vector<double> errors, nees;

    Errors(std::uint64_t seed, int count, double told) {
        Normals normals(seed);
        for (int i = 0; i < count; ++i) {
            double sum = 0;
            for (int j = 1; j <= 3; ++j) {
                const double score = normals();
                errors.push_back(j * score);
                sum += score * score / (told * told);
            }
            nees.push_back(sum);
        }
    }
};

}  // namespace

TEST_CASE("credibility: both indices agree with NumPy, trials without a NEES left out") {
    for (const Json& one : reference("credibility")) {
        const Credibility c = credibility(numbers(one["nees"]), numbers(one["errors"]), one["n"]);
        CHECK(c.count == one["count"]);
        check_agrees(c.nci, one["nci"]);
        check_agrees(c.inclination, one["inclination"]);
    }
}

TEST_CASE("credibility: a covariance too small by a factor inclines by its ten logarithms") {
    // Errors (+-1, 0), (0, +-1): M = I/2, eps* = 2.
    const std::vector<double> errors{1, 0, -1, 0, 0, 1, 0, -1};
    const Credibility exact = credibility({2, 2, 2, 2}, errors, 2);
    CHECK_THAT(exact.nci, WithinAbs(0, 1e-14));
    CHECK_THAT(exact.inclination, WithinAbs(0, 1e-14));
    const Credibility optimistic = credibility({4, 4, 4, 4}, errors, 2);
    check_agrees(optimistic.nci, 10 * std::log10(2.0));
    check_agrees(optimistic.inclination, 10 * std::log10(2.0));
    const Credibility both = credibility({4, 1, 4, 1}, errors, 2);
    check_agrees(both.nci, 10 * std::log10(2.0));
    CHECK_THAT(both.inclination, WithinAbs(0, 1e-14));
    check_agrees(credibility({1, 1, 1, 1}, errors, 2).inclination, -10 * std::log10(2.0));
}

TEST_CASE("credibility: NaN where the mean square error has no inverse") {
    const auto check_none = [](const std::vector<double>& nees, const std::vector<double>& errors, int n, int count) {
        const Credibility c = credibility(nees, errors, n);
        CHECK(c.count == count);
        CHECK(std::isnan(c.nci));
        CHECK(std::isnan(c.inclination));
    };
    check_none({}, {}, 2, 0);
    check_none({1, 1}, {1, 0, 0, 1}, 2, 2);                              // N = n
    check_none({1, missing, 1}, {1, 0, 3, 4, 0, 1}, 2, 2);               // N = n of those with a NEES
    check_none({1, 1, 1, 1}, {1, 3, 0.1, 0.3, -0.7, -2.1, 2, 6}, 2, 4);  // one component is three times the other
    for (const double h : {1e-8, 3e-8, 1e-7})                            // or nearly so, but for rounding
        check_none({1, 1, 1, 1}, {1, 3 + h, 0.1, 0.3 - h, -0.7, -2.1 + h, 2, 6 + h}, 2, 4);
    check_none({1, 1, 1}, {1, 0, 2, 0, 3, 0}, 2, 3);        // one is always 0
    check_none({1, 1, 1}, {1, missing, 2, 0, 3, 1}, 2, 3);  // one is not known
}

TEST_CASE("credibility: units do not matter") {
    const Errors data(61, 50, 1);
    std::vector<double> other_targets = data.errors;
    for (std::size_t i = 0; i < other_targets.size(); ++i) other_targets[i] *= i % 3 == 0 ? 1e9 : i % 3 == 1 ? 1 : 1e-9;
    const Credibility a = credibility(data.nees, data.errors, 3), b = credibility(data.nees, other_targets, 3);
    check_agrees(b.nci, a.nci);
    check_agrees(b.inclination, a.inclination);
}

TEST_CASE("credibility: a filter that is right is credible, one that assumes 0.8 of sigma inclines to optimism") {
    // The mean of log rho has a standard deviation of about sqrt(2 / (n N)) = 0.013, times 10 / log 10 = 0.056: beyond
    // 0.28 with 6e-7. |log10 rho| of a trial is about that of its own direction: below 0.28 too.
    const Errors right(67, 4000, 1), wrong(67, 4000, 0.8);
    const Credibility credible = credibility(right.nees, right.errors, 3);
    CHECK(std::abs(credible.inclination) < 0.28);
    CHECK(credible.nci < 0.28);
    const Credibility optimistic = credibility(wrong.nees, wrong.errors, 3);
    CHECK_THAT(optimistic.inclination - credible.inclination, WithinAbs(-20 * std::log10(0.8), 1e-9));
}

}  // namespace credence::test::credibility_test
