// Sight and clearance in the plane, against whole numbers and against plain geometry.

#include "catch.hpp"

#include <credence/detail/visibility.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace credence::test::visibility_test {

namespace {

using Point = Vector2<double>;

/// Exactly, for small whole numbers: 1, 0 or -1 for c left of, on or right of the line from a to b.
int side(const Point& a, const Point& b, const Point& c) {
    const auto whole = [](double x) { return static_cast<long>(x); };
    const long area = (whole(b.x) - whole(a.x)) * (whole(c.y) - whole(a.y)) -
                      (whole(b.y) - whole(a.y)) * (whole(c.x) - whole(a.x));
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

bool blocked_plainly(const Point& a, const Point& b, const Wall& wall) {
    return side(wall.from, wall.to, a) * side(wall.from, wall.to, b) < 0 &&
           side(a, b, wall.from) * side(a, b, wall.to) <= 0;
}

/// By the angles at the wall's ends, for walls of some length.
double distance_plainly(const Point& p, const Wall& wall) {
    const double x = wall.to.x - wall.from.x, y = wall.to.y - wall.from.y, length = std::hypot(x, y);
    const double along = ((p.x - wall.from.x) * x + (p.y - wall.from.y) * y) / length;
    if (along < 0) return std::hypot(p.x - wall.from.x, p.y - wall.from.y);
    if (along > length) return std::hypot(p.x - wall.to.x, p.y - wall.to.y);
    return std::abs((p.x - wall.from.x) * y - (p.y - wall.from.y) * x) / length;
}

/// The points of several trials, one in each lane.
template <int W>
Vector2<Lane<W>> of_lanes(const std::vector<Point>& points, std::size_t first) {
    Vector2<Lane<W>> all;
    for (int lane = 0; lane < W; ++lane) {
        set_lane(all.x, lane, points[first + static_cast<std::size_t>(lane)].x);
        set_lane(all.y, lane, points[first + static_cast<std::size_t>(lane)].y);
    }
    return all;
}

}  // namespace

TEST_CASE("visibility: a way is blocked by walls as whole numbers say, in every lane, at corners and on lines too") {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-4, 4);
    const auto point = [&] {
        const double x = coordinate(random);
        return Point{x, static_cast<double>(coordinate(random))};
    };
    int seen = 0, blocked = 0;
    for (int sample = 0; sample < 3000; ++sample) {
        std::vector<Wall> walls;
        for (int i = 0; i < sample % 4; ++i) walls.push_back({point(), point()});
        std::vector<Point> from, to;
        for (int lane = 0; lane < 4; ++lane) {
            from.push_back(point());
            to.push_back(point());
        }
        const int count = static_cast<int>(walls.size());
        const auto in_lanes_of_four =
            segment_blocked(of_lanes<4>(from, 0), of_lanes<4>(to, 0), walls.data(), count);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const bool expected = std::ranges::any_of(
                walls, [&](const Wall& wall) { return blocked_plainly(from[lane], to[lane], wall); });
            CHECK(segment_blocked(from[lane], to[lane], walls.data(), count) == expected);
            CHECK((lane_bits(in_lanes_of_four) >> lane & 1) == expected);
            ++(expected ? blocked : seen);
        }
    }
    CHECK(std::min(seen, blocked) > 1000);
}

TEST_CASE("visibility: the clearance is the distance to the nearest wall, and infinite without walls") {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const auto point = [&] {
        const double x = normal(random);
        return Point{x, normal(random)};
    };
    for (int sample = 0; sample < 2000; ++sample) {
        std::vector<Wall> walls;
        double expected = std::numeric_limits<double>::infinity();
        const std::vector<Point> points{point(), point()};
        for (int i = 0; i < sample % 4; ++i) {
            walls.push_back({point(), point()});
            expected = std::min(expected, distance_plainly(points[0], walls.back()));
        }
        const int count = static_cast<int>(walls.size());
        const double given = clearance(points[0], walls.data(), count);
        CHECK((given == expected || std::abs(given - expected) < 1e-12));  // distances are about 1, rounding 1e-16
        CHECK(lane_of(clearance(of_lanes<2>(points, 0), walls.data(), count), 0) == given);
        CHECK(lane_of(clearance(of_lanes<2>(points, 0), walls.data(), count), 1) ==
              clearance(points[1], walls.data(), count));
    }
    const Wall post{{1, 1}, {1, 1}};
    CHECK(clearance(Point{4, 5}, &post, 1) == 5);
}

TEST_CASE("visibility: a view has a range and an angle, which may be all round") {
    const View narrow{1, 3, std::cos(0.5)}, all_round{1, 3};
    for (int i = 0; i < 100; ++i) {
        const double angle = (i + 0.5) * pi / 100, distance = 0.045 * i;
        const bool in_range = distance >= 1 && distance <= 3;
        CHECK(in_view(narrow, std::cos(angle) * distance, distance) == (in_range && angle <= 0.5));
        CHECK(in_view(all_round, std::cos(angle) * distance, distance) == in_range);
    }
}

}  // namespace credence::test::visibility_test
