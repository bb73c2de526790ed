// The functions of a filter's equations against the 80-bit long double functions of the C library, and in packs against
// the same functions of doubles. Bounds in units in the last place (ulp) of the correctly rounded double.

#include "catch.hpp"
#include "ulps.hpp"

#include <credence/detail/functions.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace credence::test::functions_test {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> special{0.0,     -0.0, infinite, -infinite, no_number, 1.0, -1.0, 0x1p-1074, -0x1p-1074,
                                  0x1p-1022, 1e300, -1e300};

/// The same number, or both NaN.
bool same(double a, double b) { return bits_of(a) == bits_of(b) || (std::isnan(a) && std::isnan(b)); }

/// Numbers of every size and both signs, and the special ones, a multiple of eight of them.
std::vector<double> numbers() {
    std::mt19937_64 random(1);
    std::vector<double> all = special;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> size(-300, 300);
    while (all.size() < 4000) {
        all.push_back(normal(random));
        all.push_back(10 * normal(random));
        all.push_back(std::copysign(std::pow(10, size(random)), normal(random)));
    }
    all.resize(all.size() / 8 * 8);
    return all;
}

/// In how many lanes of packs of W a function of two numbers gives other bits than for doubles.
template <int W, class Function>
int wrong_lanes(const std::vector<double>& a, const std::vector<double>& b, const Function& function) {
    int wrong = 0;
    for (std::size_t first = 0; first < a.size(); first += W) {
        const Lane<W> value = function(load<Lane<W>>(&a[first]), load<Lane<W>>(&b[first]));
        for (int i = 0; i < W; ++i) {
            const std::size_t place = first + static_cast<std::size_t>(i);
            wrong += !same(lane_of(value, i), function(a[place], b[place]));
        }
    }
    return wrong;
}

}  // namespace

TEST_CASE("functions: exp is within 2 ulp, overflows and underflows where it must") {
    std::mt19937_64 random(2);
    double worst = 0;
    for (const double scale : {1e-10, 0.1, 1.0, 30.0, 700.0}) {
        std::uniform_real_distribution<double> x(-scale, scale);
        for (int i = 0; i < 40000; ++i) {
            const double at = x(random);
            worst = std::max(worst, ulps(credence::exp(at), std::exp(static_cast<long double>(at))));
        }
    }
    CHECK(worst < 2);
    for (double at = -746; at < -708; at += 0.001)  // subnormal results: in units of 2^-1074
        REQUIRE(ulps(credence::exp(at), std::exp(static_cast<long double>(at))) < 2);
    CHECK(credence::exp(709.78) == Approx(std::exp(709.78)).epsilon(1e-14));
    CHECK(credence::exp(0.0) == 1.0);
    for (const double at : {709.79, 1e4, infinite}) CHECK(credence::exp(at) == infinite);
    for (const double at : {-746.0, -1e4, -infinite}) CHECK(credence::exp(at) == 0);
    CHECK(std::isnan(credence::exp(no_number)));
}

TEST_CASE("functions: log takes any number") {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<std::uint64_t> positive(1, 0x7fefffffffffffffu), subnormal(1, 0x000fffffffffffffu);
    double worst = 0;
    for (int i = 0; i < 100000; ++i)
        for (const double x : {from_bits(positive(random)), from_bits(subnormal(random))})
            worst = std::max(worst, ulps(credence::log(x), std::log(static_cast<long double>(x))));
    CHECK(worst < 2);
    for (const double x : {0.0, -0.0, 1.0, -1.0, -0x1p-1074, infinite, -infinite, no_number})
        CHECK(same(credence::log(x), std::log(x)));
    CHECK(credence::log(0x1p-1074) == Approx(-1074 * std::log(2.0)).epsilon(1e-15));
}

TEST_CASE("functions: atan2 is within 2.5 ulp in every quadrant, and its special cases are those of the C library") {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> size(-15, 15);
    double worst = 0;
    const auto compare = [&](double y, double x) {
        const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
        worst = std::max(worst, ulps(credence::atan2(y, x), exact));
    };
    for (int i = 0; i < 200000; ++i) {
        compare(normal(random), normal(random));
        compare(normal(random) * std::pow(10, size(random)), normal(random));
    }
    for (int i = 0; i < 4000; ++i) {  // about the multiples of an eighth of a turn, where its pieces meet
        const double angle = (i % 16) * std::atan(1.0) / 2 + 1e-9 * normal(random);
        compare(std::sin(angle), std::cos(angle));
    }
    CHECK(worst < 2.5);  // three roundings of a quotient, then that of the sum
    for (const double y : special)
        for (const double x : special) {
            CAPTURE(y, x);
            const double value = credence::atan2(y, x), expected = std::atan2(y, x);
            CHECK((same(value, expected) || ulps(value, expected) < 2));
        }
}

TEST_CASE("functions: every lane has the bits of a double, special numbers included") {
    const std::vector<double> a = numbers();
    std::vector<double> b(a.rbegin(), a.rend());
    const auto check = [&](const char* name, const auto& function) {
        CAPTURE(name);
        CHECK(wrong_lanes<1>(a, b, function) == 0);
        CHECK(wrong_lanes<2>(a, b, function) == 0);
        CHECK(wrong_lanes<4>(a, b, function) == 0);
        CHECK(wrong_lanes<8>(a, b, function) == 0);
    };
    check("sin", [](auto x, auto) { return credence::sin(x); });
    check("cos", [](auto x, auto) { return credence::cos(x); });
    check("exp", [](auto x, auto) { return credence::exp(x); });
    check("log", [](auto x, auto) { return credence::log(x); });
    check("sqrt", [](auto x, auto) { return credence::sqrt(x); });
    check("atan2", [](auto y, auto x) { return credence::atan2(y, x); });
    check("min", [](auto x, auto y) { return credence::min(x, y); });
    check("max", [](auto x, auto y) { return credence::max(x, y); });
    check("wrapped", [](auto x, auto) { return credence::wrapped(x); });
    check("select", [](auto x, auto y) { return credence::select(x < y, x * y + 2, y / x - 0.5); });
}

TEST_CASE("functions: min and max are those of the standard library, and any and all see every lane") {
    for (const double x : special)
        for (const double y : special) {
            CHECK(same(credence::min(x, y), std::min(x, y)));
            CHECK(same(credence::max(x, y), std::max(x, y)));
        }
    for (unsigned bits = 0; bits < 16; ++bits) {
        const LaneMask<4> mask = mask_of_bits<Lane<4>>(bits);
        CHECK(any(mask) == (bits != 0));
        CHECK(all(mask) == (bits == 15));
        CHECK(lane_bits(Lane<4>(1.0) != select(mask, Lane<4>(1.0), Lane<4>(2.0))) == (bits ^ 15u));
    }
}

}  // namespace credence::test::functions_test
