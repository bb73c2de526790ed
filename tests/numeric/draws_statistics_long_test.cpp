// The distribution of the keyed draws. Fixed seeds; a false-alarm rate is what another seed would have.

#include "catch.hpp"

#include <credence/detail/draws.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace credence::test::draws_statistics_long_test {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr int pairs = 1 << 18;

/// `pairs` pairs over trials, poses and features as a study draws them.
std::vector<Vector2<double>> normal_pairs(std::uint64_t seed, double truncate, Source source = Source::walk) {
    std::vector<Vector2<double>> draws;
    for (std::uint64_t trial = 0; static_cast<int>(draws.size()) < pairs; ++trial)
        for (int pose = 0; pose < 64; ++pose)
            for (int index = 0; index < 4; ++index)
                draws.push_back(KeyedDraws<double>(seed, trial, truncate).normal(source, pose, index));
    return draws;
}

std::vector<double> components(const std::vector<Vector2<double>>& draws) {
    std::vector<double> values;
    for (const Vector2<double>& draw : draws) values.insert(values.end(), {draw.x, draw.y});
    return values;
}

double mean(const std::vector<double>& values, const std::function<double(double)>& f) {
    double sum = 0;
    for (const double value : values) sum += f(value);
    return sum / static_cast<double>(values.size());
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// sqrt(N) times the greatest distance of the empirical from the given distribution [Kolmogorov, Smirnov].
double kolmogorov(std::vector<double> values, const std::function<double(double)>& cdf) {
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    double greatest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double p = cdf(values[i]);
        greatest = std::max({greatest, static_cast<double>(i + 1) / n - p, p - static_cast<double>(i) / n});
    }
    return greatest * std::sqrt(n);
}

// P(sqrt(N) D > 2.7) is 2 exp(-2 2.7^2) = 9e-7.
constexpr double kolmogorov_bound = 2.7;

/// Correlation times sqrt(N): standard normal where two columns have nothing to do with each other.
double correlation_score(const std::vector<double>& a, const std::vector<double>& b) {
    const double n = static_cast<double>(a.size());
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sa += a[i], sb += b[i], saa += a[i] * a[i], sbb += b[i] * b[i], sab += a[i] * b[i];
    const double covariance = sab / n - sa / n * (sb / n);
    return covariance / std::sqrt((saa / n - sa / n * (sa / n)) * (sbb / n - sb / n * (sb / n))) * std::sqrt(n);
}

}  // namespace

TEST_CASE("draws: moments of the normal draws are a normal's") {
    // Each score is standard normal: beyond 5 with 6e-7, four of them 2.3e-6.
    const std::vector<double> x = components(normal_pairs(1, never));
    const double n = static_cast<double>(x.size());
    CHECK(std::abs(mean(x, [](double v) { return v; })) * std::sqrt(n) < 5);
    CHECK(std::abs(mean(x, [](double v) { return v * v; }) - 1) * std::sqrt(n / 2) < 5);
    CHECK(std::abs(mean(x, [](double v) { return v * v * v; })) * std::sqrt(n / 15) < 5);
    CHECK(std::abs(mean(x, [](double v) { return v * v * v * v; }) - 3) * std::sqrt(n / 96) < 5);
}

TEST_CASE("draws: normal draws are distributed as a normal, from every source", "[long]") {
    // Seven tests, each a false alarm with 9e-7.
    for (std::uint32_t source = 0; source < 7; ++source)
        CHECK(kolmogorov(components(normal_pairs(2, never, Source{source})), normal_cdf) < kolmogorov_bound);
}

TEST_CASE("draws: the two components, neighbouring keys and other sources are independent") {
    // Ten scores beyond 5 with 6e-6. Squares too: Box and Muller's pair shares its radius.
    const std::vector<Vector2<double>> walk = normal_pairs(3, never),
                                       other = normal_pairs(3, never, Source::deformation);
    const auto column = [](const std::vector<Vector2<double>>& draws, bool second, std::size_t shift, bool squared) {
        std::vector<double> values;
        for (std::size_t i = 0; i < draws.size(); ++i) {
            const Vector2<double>& draw = draws[(i + shift) % draws.size()];
            const double value = second ? draw.y : draw.x;
            values.push_back(squared ? value * value : value);
        }
        return values;
    };
    for (const bool squared : {false, true}) {
        const std::vector<double> x = column(walk, false, 0, squared);
        CHECK(std::abs(correlation_score(x, column(walk, true, 0, squared))) < 5);
        for (const std::size_t shift : {1u, 4u, 256u})  // next feature, next pose, next trial
            CHECK(std::abs(correlation_score(x, column(walk, false, shift, squared))) < 5);
        CHECK(std::abs(correlation_score(x, column(other, false, 0, squared))) < 5);
    }
}

TEST_CASE("draws: uniforms fill 0 to 1 evenly and know nothing of the normals") {
    std::vector<double> uniforms, normals;
    for (std::uint64_t trial = 0; trial < 2000; ++trial) {
        const KeyedDraws<double> draws(4, trial, never);
        for (int pose = 0; pose < 20; ++pose)
            for (int index = 0; index < 3; ++index) {
                uniforms.push_back(draws.uniform(Source::detection, pose, index));
                normals.push_back(draws.normal(Source::measurement, pose, index).x);
            }
    }
    CHECK(*std::min_element(uniforms.begin(), uniforms.end()) >= 0);
    CHECK(*std::max_element(uniforms.begin(), uniforms.end()) < 1);
    CHECK(kolmogorov(uniforms, [](double u) { return u; }) < kolmogorov_bound);
    CHECK(std::abs(correlation_score(uniforms, normals)) < 5);  // 6e-7
}

TEST_CASE("draws: truncation keeps within its multiple of sigma and has a truncated normal's distribution", "[long]") {
    for (const double t : {0.1, 0.5, 2.0, 3.0}) {
        const std::vector<double> x = components(normal_pairs(5, t));
        CAPTURE(t);
        CHECK(std::all_of(x.begin(), x.end(), [=](double v) { return std::abs(v) <= t; }));
        const double below = normal_cdf(-t), within = normal_cdf(t) - below;
        CHECK(kolmogorov(x, [=](double v) { return (normal_cdf(v) - below) / within; }) < kolmogorov_bound);
    }
}

TEST_CASE("draws: truncation redraws only the component that is beyond, and keeps the others to the bit") {
    const double t = 1.0;
    int kept_alone = 0;
    for (std::uint64_t trial = 0; trial < 20000; ++trial) {
        const Vector2<double> first = KeyedDraws<double>(6, trial, never).normal(Source::measurement, 3, 1);
        const Vector2<double> cut = KeyedDraws<double>(6, trial, t).normal(Source::measurement, 3, 1);
        const bool good_x = std::abs(first.x) <= t, good_y = std::abs(first.y) <= t;
        REQUIRE((cut.x == first.x) == good_x);
        REQUIRE((cut.y == first.y) == good_y);
        kept_alone += good_x != good_y;
    }
    CHECK(kept_alone > 5000);  // 0.68 * 0.32 * 2 of them: the case is not empty
}

TEST_CASE("draws: truncation does not touch the uniforms") {
    for (int pose = 0; pose < 100; ++pose)
        CHECK(KeyedDraws<double>(1, 1, 0.5).uniform(Source::detection, pose, 0) ==
              KeyedDraws<double>(1, 1, never).uniform(Source::detection, pose, 0));
}

}  // namespace credence::test::draws_statistics_long_test
