// The truth [docs/model.md, Truth], with noise that the test chooses.

#include "catch.hpp"
#include "support.hpp"

#include "slam/trial/problem.hpp"

#include <cmath>

namespace credence::test::world_test {

namespace {

using Heading = Layout<Process::heading, 3>;
using Translation = Layout<Process::translation, 3>;

/// Every draw of a source is the same pair at all poses and features; all others are 0.
AnyNoise constant_noise(Source source, Vector2<double> pair) {
    AnyNoise noise = silent_noise();
    noise.normal_draw = [=](Source s, int, int) { return s == source ? pair : Vector2<double>{}; };
    return noise;
}

/// A draw that encodes its source, pose and index.
AnyNoise telling_noise() {
    AnyNoise noise = silent_noise();
    noise.normal_draw = [](Source source, int pose, int index) {
        const double number = 100 * static_cast<double>(source) + pose + 0.1 * index;
        return Vector2<double>{number, -2 * number};
    };
    return noise;
}

double distance(const Vector2<double>& a, double x, double y) { return std::hypot(a.x - x, a.y - y); }

/// Truth at a pose after moving features and robot (by a command) there from pose 0.
template <class Layout>
Truth<double, 3> truth_at(const Problem& problem, int pose, const Command<double>& command, const AnyNoise& noise) {
    Truth<double, 3> truth;
    const WorldParameters& world = problem.view().world;
    start_truth(truth, world, Layout(3), draws_at<Layout>(noise, 0), noise);
    for (int k = 1; k <= pose; ++k) {
        const auto draws = draws_at<Layout>(noise, k);
        move_features(truth, world, Layout(3), k, draws);
        move_robot(truth, world, command, draws);
    }
    return truth;
}

struct Moments {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double value) { sum += value, squares += value * value, ++count; }
    /// Scores of mean 0 and of the variance; standard normal where they are right.
    double mean_score(double variance) const { return sum / std::sqrt(count * variance); }
    double variance_score(double variance) const { return (squares / (count * variance) - 1) * std::sqrt(count / 2.0); }
};

constexpr double rounding = 1e-12;  // a few additions of numbers of size 1 to 1e3, each good to 1e-13

}  // namespace

TEST_CASE("world: without noise, features stand where they were put and the robot at 0") {
    const Problem problem(scenario_with({{"features.sway_amplitude", "0.7"}}));
    const Truth<double, 3> truth = truth_at<Heading>(problem, 0, {}, silent_noise());
    CHECK(truth.heading == 0);
    CHECK(distance(truth.position, 0, 0) == 0);
    CHECK(distance(truth.feature[0], 0.5, 0.5) == 0);
    CHECK(distance(truth.feature[1], 0.9, 0.8) == 0);
    CHECK(distance(truth.feature[2], 0.3, 0.4) == 0);
}

TEST_CASE("world: the first pose is drawn with its own sigmas") {
    const Problem problem(scenario_with({{"noise.initial_heading", "0.5"}, {"noise.initial_position", "0.25"}}));
    const Truth<double, 3> truth = truth_at<Heading>(problem, 0, {}, telling_noise());
    CHECK(truth.heading == 0.5 * 0);
    CHECK(distance(truth.position, 0.25 * 100, 0.25 * -200) < rounding);
    const AnyNoise heading = constant_noise(Source::odometry_heading, {2, 9});
    CHECK(truth_at<Heading>(problem, 0, {}, heading).heading == 1);
}

TEST_CASE("world: the walk leaving a pose and the deformation at a pose move the features") {
    // jitter: c_k sums the walks of poses 0 ... k - 1; p_k adds the deformation of pose k alone.
    const Problem problem(scenario_with({{"noise.walk", "0.5"}, {"noise.deformation", "0.25"}}));
    const Truth<double, 3> truth = truth_at<Heading>(problem, 2, {}, telling_noise());
    for (int j = 0; j < 3; ++j) {
        const Point start = problem.scenario().features.positions[static_cast<std::size_t>(j)];
        const double walked = 0.5 * ((200 + 0.1 * j) + (201 + 0.1 * j)), deformed = 0.25 * (302 + 0.1 * j);
        CHECK(distance(truth.centre[j], start.x + 4 + walked, start.y - 2 * walked) < rounding);
        CHECK(distance(truth.feature[j], start.x + 4 + walked + deformed, start.y - 2 * (walked + deformed)) <
              rounding);
    }
}

TEST_CASE("world: a deformation that walks accumulates from pose 1 on") {
    const Problem problem(
        scenario_with({{"noise.walk", "0.5"}, {"noise.deformation", "0.25"}, {"truth.deformation", "walk"}}));
    const Truth<double, 3> start = truth_at<Heading>(problem, 0, {}, telling_noise());
    CHECK(distance(start.feature[1], 0.9, 0.8) == 0);
    const Truth<double, 3> truth = truth_at<Heading>(problem, 2, {}, telling_noise());
    const double moved = 0.5 * (200.1 + 201.1) + 0.25 * (301.1 + 302.1);
    CHECK(distance(truth.feature[1], 0.9 + 4 + moved, 0.8 - 2 * moved) < rounding);
    CHECK(distance(truth.feature[1], truth.centre[1].x, truth.centre[1].y) == 0);
}

TEST_CASE("world: the robot moves by its heading of before, then turns") {
    const Problem problem(scenario_with({{"noise.heading", "0.01"}, {"noise.odometry", "0.5"}}));
    const double turn = 0.4;
    const Truth<double, 3> truth = truth_at<Heading>(problem, 2, {turn, {2, 1}}, telling_noise());
    const double first_heading = turn + 0.01 * 1, c = std::cos(first_heading), s = std::sin(first_heading);
    CHECK(std::abs(truth.heading - (first_heading + turn + 0.01 * 2)) < rounding);
    const double x = 2 + 0.5 * 101 + (2 * c - s) + 0.5 * 102, y = 1 - 0.5 * 202 + (2 * s + c) - 0.5 * 204;
    CHECK(distance(truth.position, x, y) < rounding);
}

TEST_CASE("world: the translation model moves in the world frame and never turns") {
    const Problem problem(scenario_with({{"model.process", "translation"}, {"noise.odometry", "0.5"}}));
    const Truth<double, 3> truth = truth_at<Translation>(problem, 2, {0.4, {2, 1}}, telling_noise());
    CHECK(truth.heading == 0);
    CHECK(distance(truth.position, 4 + 0.5 * 203, 2 - 0.5 * 406) < rounding);
}

TEST_CASE("world: paths of the features") {
    const auto at_end = [](const char* path, const char* turn) {
        Eigen::Vector2d sum(0, 0);
        for (const Point& t : feature_translations(
                 scenario_with({{"features.path", path}, {"features.turn", turn}, {"features.step", "1.5"}})))
            sum += Eigen::Vector2d(t.x, t.y);
        return sum;
    };
    CHECK((at_end("straight", "0.3") - Eigen::Vector2d(19 * 1.5, 0)).norm() < rounding);
    CHECK(at_end("static", "0.3").norm() == 0);
    // A polygon of equal steps: from its chord of 19 turns, at the mean direction delta/2 + 9 delta.
    const double delta = 0.3, chord = 1.5 * std::sin(19 * delta / 2) / std::sin(delta / 2), direction = 9.5 * delta;
    CHECK((at_end("circle", "0.3") - chord * Eigen::Vector2d(std::cos(direction), std::sin(direction))).norm() <
          rounding);
}

TEST_CASE("world: sway is A (sin psi, cos psi) less its value at pose 0, and the filter knows its increment") {
    const Problem problem(scenario_with({{"features.sway_amplitude", "0.7"}, {"features.sway_period", "13"}}));
    const ProblemView& view = problem.view();
    const auto raw = [](int k, int j) {
        const double psi = 2 * M_PI * k / 13 + 2 * M_PI * j / 3;
        return Eigen::Vector2d(0.7 * std::sin(psi), 0.7 * std::cos(psi));
    };
    for (int k = 0; k < 20; ++k)
        for (int j = 0; j < 3; ++j) {
            const Point o = view.world.sway_at(k, j);
            CHECK((Eigen::Vector2d(o.x, o.y) - (raw(k, j) - raw(0, j))).norm() < 1e-14);  // sums of numbers below 1.4
            if (k == 0) continue;
            const Point d = view.filter.sway_increment_at(k, j);
            CHECK((Eigen::Vector2d(d.x, d.y) - (raw(k, j) - raw(k - 1, j))).norm() < 1e-14);
        }
    const Truth<double, 3> truth = truth_at<Heading>(problem, 5, {}, silent_noise());
    const Eigen::Vector2d o = raw(5, 1) - raw(0, 1);
    CHECK(distance(truth.feature[1], 0.9 + 10 + o.x(), 0.8 + o.y()) < rounding);
}

TEST_CASE("world: moments of the truth at the last pose") {
    // 4000 trials, 3 features, 2 axes: per case six scores beyond 5 with 4e-6 (features of a trial are independent).
    for (const char* deformation : {"jitter", "walk"}) {
        const DeformableSettings scenario = scenario_with({{"truth.deformation", deformation},
                                                           {"noise.heading", "0.05"},
                                                           {"noise.initial_heading", "0.2"},
                                                           {"noise.initial_position", "0.3"}});
        const Problem problem(scenario);
        Moments feature, heading, position;
        for (std::uint64_t trial = 0; trial < 4000; ++trial) {
            const auto truth = truth_at<Heading>(problem, 19, {0.1, {0, 0}}, keyed_noise(scenario, 3, trial));
            for (int j = 0; j < 3; ++j) {
                const Point start = scenario.features.positions[static_cast<std::size_t>(j)];
                feature.add(truth.feature[j].x - start.x - 38);
                feature.add(truth.feature[j].y - start.y);
            }
            heading.add(truth.heading - 1.9);
            position.add(truth.position.x);
            position.add(truth.position.y);
        }
        const double feature_variance = 19 * 0.09 + (scenario.truth.deformation == Deformation::walk ? 19 : 1) * 0.04;
        const double heading_variance = 0.04 + 19 * 0.0025, position_variance = 0.09 + 19 * 0.0004;
        CAPTURE(deformation);
        CHECK(std::abs(feature.mean_score(feature_variance)) < 5);
        CHECK(std::abs(feature.variance_score(feature_variance)) < 5);
        CHECK(std::abs(heading.mean_score(heading_variance)) < 5);
        CHECK(std::abs(heading.variance_score(heading_variance)) < 5);
        CHECK(std::abs(position.mean_score(position_variance)) < 5);
        CHECK(std::abs(position.variance_score(position_variance)) < 5);
    }
}

}  // namespace credence::test::world_test
