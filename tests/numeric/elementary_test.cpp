// Elementary functions against the 80-bit long double functions of the C library. Bounds in units in the last place
// (ulp) of the correctly rounded double.

#include "catch.hpp"
#include "ulps.hpp"

#include <credence/detail/elementary.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace credence::test::elementary_test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr long double exact_pi = 3.14159265358979323846264338327950288L;
constexpr long double rest_of_pi = -5.0165576126683320235573270803307570314e-20L;  // pi - exact_pi

double log_error(double x) { return ulps(log_of_normal(x), std::log(static_cast<long double>(x))); }

/// The larger of the errors of cosine and sine.
double rotation_error(double angle) {
    const Rotation<double> r = rotation(angle);
    const long double a = angle;
    return std::max(ulps(r.cosine, std::cos(a)), ulps(r.sine, std::sin(a)));
}

/// sin(2 pi turns) and cos with the turns reduced exactly, so that the reference is good near their zeros too.
double turns_error(double turns) {
    const Rotation<double> r = rotation_of_turns(turns);
    const int quarter = static_cast<int>(std::nearbyint(4 * turns));
    const long double rest = 2 * exact_pi * (static_cast<long double>(turns) - quarter / 4.0L);
    const long double s = std::sin(rest), c = std::cos(rest);
    const long double sines[] = {s, c, -s, -c}, cosines[] = {c, -s, -c, s};
    return std::max(ulps(r.cosine, cosines[quarter % 4]), ulps(r.sine, sines[quarter % 4]));
}

}  // namespace

TEST_CASE("elementary: log is within 1.5 ulp of all normal positive numbers") {
    // The bounds that elementary.hpp states. Random bit patterns cover all exponents; dense grids cover the arguments
    // of Box and Muller's transform.
    std::mt19937_64 random(1);
    double worst = 0;
    std::uniform_int_distribution<std::uint64_t> normal_positive(0x0010000000000000u, 0x7fefffffffffffffu);
    for (int i = 0; i < 200000; ++i) worst = std::max(worst, log_error(from_bits(normal_positive(random))));
    for (int i = 1; i <= 100000; ++i) worst = std::max(worst, log_error(i / 100000.0));
    for (int i = 1; i <= 50000; ++i) worst = std::max(worst, log_error(1 + i / 50000.0));
    CHECK(worst < 1.5);
}

TEST_CASE("elementary: log is within 1.5 ulp where its pieces meet") {
    for (const double centre : {1.0, std::sqrt(0.5), std::sqrt(2.0), 0.5, 2.0, 0x1p-52, 0x1p52}) {
        double x = centre;
        for (int i = 0; i < 1000; ++i) x = std::nextafter(x, 0.0);
        for (int i = 0; i < 2000; ++i, x = std::nextafter(x, infinity)) {
            CAPTURE(centre, i);
            REQUIRE(log_error(x) < 1.5);
        }
    }
    CHECK(log_of_normal(1.0) == 0.0);
    CHECK(log_error(std::numeric_limits<double>::min()) < 1.5);
    CHECK(log_error(std::numeric_limits<double>::max()) < 1.5);
}

TEST_CASE("elementary: log never rises above its neighbour by more than its error") {
    // Monotone to within the 1.5 ulp on either side.
    double x = 0.7, before = log_of_normal(x);
    for (int i = 0; i < 10000; ++i) {
        x = std::nextafter(x, 1.0);
        const double now = log_of_normal(x);
        REQUIRE(now >= before - 3 * 0x1p-54);
        before = now;
    }
}

TEST_CASE("elementary: rotation is within 1.5 ulp for angles below 2^30") {
    std::mt19937_64 random(2);
    double worst = 0;
    for (const double scale : {1e-300, 1e-9, 0.1, 1.0, 7.0, 1e3, 1e6, 0x1p30}) {
        std::uniform_real_distribution<double> angle(-scale, scale);
        for (int i = 0; i < 40000; ++i) worst = std::max(worst, rotation_error(angle(random)));
    }
    for (int i = -100000; i <= 100000; ++i) worst = std::max(worst, rotation_error(i * 1e-4));
    CHECK(worst < 1.5);
}

TEST_CASE("elementary: rotation is within 1.5 ulp where quadrants and octants meet") {
    // Next to multiples of pi/2 one of the two is nearly 0, and the reduction must not lose its digits.
    std::mt19937_64 random(3);
    std::uniform_int_distribution<int> far_multiple(-(1 << 30), 1 << 30);
    for (int i = -2000; i <= 2000; ++i) {
        const int eighths = i < -1000 || i > 1000 ? far_multiple(random) : i;
        double angle = static_cast<double>(eighths * (exact_pi / 4));
        for (int step = 0; step < 5; ++step) angle = std::nextafter(angle, -infinity);
        for (int step = 0; step < 11; ++step, angle = std::nextafter(angle, infinity)) {
            CAPTURE(eighths, angle);
            REQUIRE(rotation_error(angle) < 1.5);
        }
    }
}

TEST_CASE("elementary: rotation is exact at 0, odd in its sine and even in its cosine") {
    CHECK(rotation(0.0).cosine == 1.0);
    CHECK(rotation(0.0).sine == 0.0);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> angles(-100, 100);
    for (int i = 0; i < 20000; ++i) {
        const double angle = angles(random);
        const Rotation<double> plus = rotation(angle), minus = rotation(-angle);
        REQUIRE(minus.cosine == plus.cosine);
        REQUIRE(minus.sine == -plus.sine);
    }
}

TEST_CASE("elementary: rotation of what is no angle is NaN") {
    for (const double angle : {not_a_number, -not_a_number, infinity, -infinity}) {
        CHECK(std::isnan(rotation(angle).cosine));
        CHECK(std::isnan(rotation(angle).sine));
    }
}

TEST_CASE("elementary: rotation of turns is within 2 ulp") {
    // One rounding of the product with pi/2 and one of pi/2 itself come on top of the series.
    std::mt19937_64 random(5);
    std::uniform_int_distribution<std::uint64_t> fraction(0, (std::uint64_t{1} << 52) - 1);
    double worst = 0;
    for (int i = 0; i < 200000; ++i)
        worst = std::max(worst, turns_error(static_cast<double>(fraction(random)) * 0x1p-52));
    for (int eighth = 0; eighth <= 8; ++eighth)
        for (int step = -500; step <= 500; ++step) {
            const double turns = eighth / 8.0 + step * 0x1p-52;
            if (turns >= 0 && turns < 1) worst = std::max(worst, turns_error(turns));
        }
    CHECK(worst < 2);
}

TEST_CASE("elementary: quarter turns are exact") {
    const double expected[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Rotation<double> r = rotation_of_turns(quarter / 4.0);
        CHECK(r.cosine == expected[quarter][0]);
        CHECK(r.sine == expected[quarter][1]);
    }
}

TEST_CASE("elementary: rotate and rotate_back are R a and R' a") {
    // R = [cos, -sin; sin, cos], for which a quarter turn takes the x axis to the y axis.
    const Rotation<double> quarter = rotation_of_turns(0.25);
    CHECK(rotate(quarter, Vector2<double>{1, 0}).y == 1);
    CHECK(rotate(quarter, Vector2<double>{0, 1}).x == -1);
    CHECK(rotate_back(quarter, Vector2<double>{0, 1}).x == 1);
    CHECK(rotate_back(quarter, Vector2<double>{1, 0}).y == -1);
    const Vector2<double> a{0.3, -1.7}, there = rotate(rotation(0.7), a), back = rotate_back(rotation(0.7), there);
    const double long_way = std::hypot(back.x - a.x, back.y - a.y);
    CHECK(long_way < 4 * 0x1p-52);  // two rotations of a vector of length 1.7, each within an ulp or two
}

TEST_CASE("elementary: wrapped brings a heading between -pi and pi and changes it by whole turns") {
    // 2 pi comes in two parts; what is cut off is 1e-32 a turn, so only the last rounding is left (and the first one,
    // where it is not exact). The choice of the turn itself is rounded: near pi it may overshoot by that.
    std::mt19937_64 random(6);
    for (const double scale : {1e-12, 1.0, 3.2, 10.0, 1e3, 1e6}) {
        std::uniform_real_distribution<double> angles(-scale, scale);
        for (int i = 0; i < 20000; ++i) {
            const double angle = angles(random), short_way = wrapped(angle);
            const long double turns = std::nearbyint(static_cast<long double>(angle - short_way) / (2 * exact_pi));
            const long double exact =
                std::fma(-turns, 2 * exact_pi, static_cast<long double>(angle)) - turns * 2 * rest_of_pi;
            CAPTURE(angle);
            REQUIRE(std::abs(short_way) <= pi + std::abs(angle) * 0x1p-51);
            REQUIRE(ulps(short_way, exact) < 1.5);
        }
    }
}

TEST_CASE("elementary: wrapped leaves small angles alone, keeps NaN and tells the two sides of pi apart") {
    for (const double angle : {0.0, 1e-300, -1e-3, 1.5, -3.1, 3.14159}) CHECK(wrapped(angle) == angle);
    CHECK(wrapped(pi + 0.01) == Approx(-pi + 0.01).epsilon(1e-14));
    CHECK(wrapped(-pi - 0.01) == Approx(pi - 0.01).epsilon(1e-14));
    CHECK(wrapped(5 * pi / 2) == Approx(pi / 2).epsilon(1e-14));
    CHECK(std::isnan(wrapped(not_a_number)));
    CHECK(std::isnan(wrapped(infinity)));
}

}  // namespace credence::test::elementary_test
