// Scales and ticks over every range that doubles have.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "catch.hpp"
#include "report/html/charts/chart.hpp"

namespace credence::test::scale_test {

namespace {

/// Doubles at the ends of what there is, and neighbours of others; then any bits.
std::vector<double> hostile_values() {
    using limits = std::numeric_limits<double>;
    std::vector<double> values{0.0,
                               1.0,
                               2.0,
                               1e-3,
                               1e15,
                               9007199254740993.0,
                               1e300,
                               1e308,
                               limits::max(),
                               limits::min(),
                               limits::denorm_min(),
                               3 * limits::denorm_min(),
                               1e-310};
    for (std::size_t i = 0, count = values.size(); i < count; ++i) {
        values.push_back(std::nextafter(values[i], limits::max()));
        values.push_back(-values[i]);
    }
    std::mt19937_64 random(1);
    while (values.size() < 120)
        if (const double value = std::bit_cast<double>(random()); std::isfinite(value)) values.push_back(value);
    return values;
}

void check_ticks(const Scale& scale, int about) {
    const std::vector<double> found = ticks(scale, about);
    CHECK(found.size() <= static_cast<std::size_t>(3 * about + 3));
    CHECK(tick_texts(found).size() == found.size());
    for (const double tick : found) {
        CHECK(std::isfinite(tick));
        CHECK((scale(tick) >= std::min(scale.from, scale.to) && scale(tick) <= std::max(scale.from, scale.to)));
    }
}

}  // namespace

TEST_CASE("chart: over every finite range ticks are few and every value has its place on the axis") {
    const std::vector<double> values = hostile_values();
    for (const double a : values)
        for (const double b : values) {
            CAPTURE(a, b);
            Range range;
            range.include(a);
            range.include(b);
            for (const Scale& scale : {range.scale(0, 100, INFINITY), range.scale(0, 100, 1),
                                       scale_between(ScaleKind::logarithmic, a, b, 0, 100)}) {
                CHECK(scale.low < scale.high);
                for (const double value : {a, b, 0.0, -1.0}) CHECK((scale(value) >= 0 && scale(value) <= 100));
                for (const int about : {1, 5, 8}) check_ticks(scale, about);
            }
        }
}

TEST_CASE("chart: ticks of a scale without a place for them are none") {
    CHECK(ticks({ScaleKind::linear, 0, std::numeric_limits<double>::denorm_min(), 0, 1}, 5).empty());
    CHECK(ticks({ScaleKind::linear, 2, std::nextafter(2.0, 3.0), 0, 1}, 5).size() <= 6);
    CHECK(ticks({ScaleKind::linear, 1, INFINITY, 0, 1}, 5).size() <= 6);
    CHECK(ticks({ScaleKind::logarithmic, 0, 100, 0, 1}, 5).empty());
}

}  // namespace credence::test::scale_test
