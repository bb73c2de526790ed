// The sensor [docs/model.md, Filter: See, Edges], with noise that the test chooses.

#include "catch.hpp"
#include "filter_samples.hpp"

#include "slam/trial/problem.hpp"

#include <cmath>

namespace credence::test::sensor_test {

namespace {

using Heading = Layout<Process::heading, 3>;
using Translation = Layout<Process::translation, 3>;

/// A robot at (1, 2) and features at the given ranges to its right.
Truth<double, 3> truth_with_ranges(double q0, double q1, double q2) {
    Truth<double, 3> truth;
    truth.rotation = rotation(0.0);
    truth.position = {1, 2};
    truth.feature[0] = {1 + q0, 2};
    truth.feature[1] = {1 + q1, 2};
    truth.feature[2] = {1 + q2, 2};
    return truth;
}

SensorParameters sensor_of(const Settings& settings) { return Problem(scenario_with(settings)).view().sensor; }

bool seen_at(double q, const SensorParameters& sensor) {
    Truth<double, 3> truth;
    truth.rotation = rotation(0.0);
    truth.feature[0] = {q, 0};
    return look_at<Heading>(truth, sensor, 1, 0, silent_noise()).seen;
}

AnyNoise measurement_noise(Vector2<double> pair) {
    AnyNoise noise = silent_noise();
    noise.normal_draw = [=](Source s, int, int) { return s == Source::measurement ? pair : Vector2<double>{}; };
    return noise;
}

constexpr double rounding = 4e-15;  // a few sums and products of numbers up to 20, most of them near 1

double distance(const Vector2<double>& a, double x, double y) { return std::hypot(a.x - x, a.y - y); }

}  // namespace

TEST_CASE("sensor: a feature is seen exactly at both ends of the range and not an ulp beyond") {
    for (const auto& [low, high] : {std::pair{0.1, 2.0}, {0.25, 0.75}, {1e-3, 1e3}}) {
        const SensorParameters sensor =
            sensor_of({{"sensor.range_min", std::to_string(low)}, {"sensor.range_max", std::to_string(high)}});
        CHECK(seen_at(low, sensor));
        CHECK(seen_at(high, sensor));
        CHECK(seen_at((low + high) / 2, sensor));
        CHECK_FALSE(seen_at(std::nextafter(low, 0.0), sensor));
        CHECK_FALSE(seen_at(std::nextafter(high, infinity), sensor));
        CHECK_FALSE(seen_at(0, sensor));
    }
}

TEST_CASE("sensor: the range is the distance between robot and feature") {
    CHECK(squared_range(Vector2<double>{1, 2}, Vector2<double>{4, 6}) == 25);
    CHECK(squared_range(Vector2<double>{4, 6}, Vector2<double>{1, 2}) == 25);
    CHECK(squared_range(Vector2<double>{1, 1}, Vector2<double>{1, 1}) == 0);
}

TEST_CASE("sensor: an unlimited range sees everything but what has no range") {
    const SensorParameters sensor = sensor_of({{"sensor.range_min", "0"}, {"sensor.range_max", "inf"}});
    CHECK(seen_at(0, sensor));
    CHECK(seen_at(1e300, sensor));
    CHECK_FALSE(seen_at(not_a_number, sensor));
}

TEST_CASE("sensor: constant noise is the same at every range") {
    const SensorParameters sensor = sensor_of({{"sensor.sigma", "0.07"}});
    for (const double q : {0.0, 0.1, 1.0, 5.0}) CHECK(sigma_at(sensor, q * q) == 0.07);
}

TEST_CASE("sensor: ranged noise grows from near to far, is flat below the range and not clamped above") {
    const SensorParameters sensor = sensor_of({{"sensor.noise", "ranged"}});
    const double few_ulp = 1e-16;  // of numbers near 0.1; those near 0.5 have ulps of 1.1e-16, and 0.5 comes out exact
    CHECK(ranged_sigma(sensor, 0.1) == 0.01);
    CHECK(ranged_sigma(sensor, 0.05) == 0.01);
    CHECK(ranged_sigma(sensor, 0.0) == 0.01);
    CHECK(std::abs(ranged_sigma(sensor, 2.0) - 0.09) < few_ulp);
    CHECK(std::abs(ranged_sigma(sensor, 1.05) - 0.05) < few_ulp);
    CHECK(std::abs(ranged_sigma(sensor, 3.9) - 0.17) < few_ulp);
    for (const double q : {0.05, 0.1, 0.7, 1.9})  // a root of a square is off by an ulp at most
        CHECK(std::abs(sigma_at(sensor, q * q) - ranged_sigma(sensor, q)) < few_ulp);
    const SensorParameters other = sensor_of({{"sensor.noise", "ranged"},
                                              {"sensor.range_min", "1"},
                                              {"sensor.range_max", "3"},
                                              {"sensor.sigma_near", "0.2"},
                                              {"sensor.sigma_far", "0.6"}});
    CHECK(std::abs(ranged_sigma(other, 2.5) - 0.5) < few_ulp);
}

TEST_CASE("sensor: a sighting is the feature in the body frame, with noise of its sigma") {
    Truth<double, 3> truth = truth_with_ranges(1, 2, 3);
    truth.feature[1] = {1.3, 3.2};
    truth.heading = 0.6;
    truth.rotation = rotation(0.6);
    const SensorParameters sensor = sensor_of({{"sensor.sigma", "0.5"}});
    const Sighting<double> sighting =
        look_at<Heading>(truth, sensor, 4, 1, measurement_noise({2, -3}));
    const double c = std::cos(0.6), s = std::sin(0.6), dx = 0.3, dy = 1.2;
    CHECK(distance(sighting.z, c * dx + s * dy + 1, -s * dx + c * dy - 1.5) < rounding);
    CHECK(sighting.sigma == 0.5);
    CHECK(sighting.seen);
    const Sighting<double> flat =
        look_at<Translation>(truth, sensor, 4, 1, measurement_noise({2, -3}));
    CHECK(distance(flat.z, dx + 1, dy - 1.5) < rounding);
}

TEST_CASE("sensor: sigma of a sighting is taken at the true range, seen or not") {
    const SensorParameters sensor = sensor_of({{"sensor.noise", "ranged"}});
    const Truth<double, 3> truth = truth_with_ranges(1.05, 3.9, 0);
    const auto at = [&](int j) { return look_at<Heading>(truth, sensor, 1, j, measurement_noise({1, 0})); };
    CHECK(at(0).sigma == Approx(0.05).epsilon(rounding));
    CHECK(distance(at(0).z, 1.05 + 0.05, 0) < rounding);
    CHECK_FALSE(at(1).seen);
    CHECK(at(1).sigma == Approx(0.17).epsilon(rounding));
    CHECK_FALSE(at(2).seen);
    CHECK(at(2).sigma == 0.01);
}

TEST_CASE("sensor: the first sight is in the world frame, whatever the range and the heading") {
    Truth<double, 3> truth = truth_with_ranges(1, 20, 0.01);
    truth.heading = 1.1;
    truth.rotation = rotation(1.1);
    const SensorParameters sensor = sensor_of({{"sensor.sigma", "0.5"}});
    Sighting<double> sights[3];
    const auto draws = draws_at<Heading>(measurement_noise({2, -3}), 0);
    look_first(truth, sensor, 3, draws.of_features<Source::measurement>(), sights);
    for (int j = 0; j < 3; ++j) {
        CHECK(distance(sights[j].z, truth.feature[j].x + 1, truth.feature[j].y - 1.5) < rounding);
        CHECK(sights[j].sigma == 0.5);
    }
}

TEST_CASE("sensor: an edge is the difference of its two features, with a noise of its own where the truth has one") {
    Truth<double, 3> truth = truth_with_ranges(1, 2, 3);
    truth.feature[2] = {7, 11};
    AnyNoise noise = silent_noise();
    noise.normal_draw = [](Source source, int pose, int index) {
        return source == Source::edge ? Vector2<double>{1.0 * pose, 10.0 * index} : Vector2<double>{};
    };
    const auto measured = [&](const char* kind) {
        return measure_edge(truth, sensor_of({{"truth.edge_noise", kind}}), {0, 2}, 3, 1, noise);
    };
    CHECK(distance(measured("none"), 5, 9) == 0);
    CHECK(distance(measured("independent"), 5 + 0.2 * 3, 9 + 0.2 * 10) < rounding);
}

TEST_CASE("sensor: a feature in range is seen with the probability of detection, by its own draw") {
    const SensorParameters sensor = sensor_of({{"sensor.detection", "0.3"}});
    const Truth<double, 3> truth = truth_with_ranges(1, 1.5, 9);
    AnyNoise noise = silent_noise();
    const auto seen = [&](int j, double uniform) {
        noise.uniform_draw = [=](Source source, int pose, int index) {
            return source == Source::detection && pose == 7 && index == j ? uniform : 0.99;
        };
        return look_at<Heading>(truth, sensor, 7, j, noise).seen;
    };
    CHECK(seen(0, 0.0));
    CHECK(seen(1, std::nextafter(0.3, 0.0)));
    CHECK_FALSE(seen(1, 0.3));
    CHECK_FALSE(seen(0, 0.9));
    CHECK_FALSE(seen(2, 0.0));
}

TEST_CASE("sensor: a share of the features in range is detected") {
    // 38000 sightings: the share errs by 5 of its standard deviations with 6e-7.
    const DeformableSettings scenario =
        scenario_with({{"sensor.detection", "0.3"}, {"sensor.range_min", "0"}, {"sensor.range_max", "inf"}});
    double seen = 0, looks = 0;
    for (std::uint64_t trial = 0; trial < 667; ++trial) {
        const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 8, trial));
        seen += 57 - run.columns[column_unseen];
        looks += 57;
    }
    CHECK(std::abs(seen / looks - 0.3) < 5 * std::sqrt(0.3 * 0.7 / looks));
}

}  // namespace credence::test::sensor_test
