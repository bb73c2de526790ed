// Features that are placed at random, measurement noise with tails, the filter's gate, a bias of the odometry and steps
// without measurements. That each agrees with the oracle is tested in keys_test.

#include "catch.hpp"
#include "support.hpp"

#include <credence/detail/elementary.hpp>
#include "slam/estimators/estimators.hpp"

#include <cmath>

namespace credence::test::disturbances_test {

namespace {

/// The score of a count of successes: standard normal where each has the probability.
double score(int count, int trials, double probability) {
    return (count - trials * probability) / std::sqrt(trials * probability * (1 - probability));
}

/// Each score of a test goes beyond this once in 150,000 runs.
constexpr double bound = 4.5;

/// Where features start, relative to the first position, over many trials.
std::vector<Eigen::Vector2d> places(const Settings& settings, std::uint64_t trials) {
    const DeformableSettings scenario = scenario_with(settings);
    std::vector<Eigen::Vector2d> all;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        const AnyNoise keyed = keyed_noise(scenario, 3, trial);
        AnyNoise noise = silent_noise();
        noise.uniform_draw = keyed.uniform_draw;
        const Eigen::VectorXd truth = run_arm(scenario, Controller::fixed, noise).steps[0].truth;
        for (Eigen::Index i = 3; i < truth.size(); i += 2)
            all.emplace_back(truth.segment<2>(i) - Eigen::Vector2d(1, -2));
    }
    return all;
}

int count_if(const std::vector<Eigen::Vector2d>& points, const std::function<bool(const Eigen::Vector2d&)>& holds) {
    return static_cast<int>(std::count_if(points.begin(), points.end(), holds));
}

}  // namespace

TEST_CASE("placement: a box about the first position is filled evenly") {
    const auto points = places({{"features.positions", "1 -2"}, {"features.placement", "box"}, {"features.count", "8"},
                                {"features.extent", "6"}, {"scenario.poses", "2"}}, 250);
    const int n = static_cast<int>(points.size());
    REQUIRE(n == 2000);
    CHECK(count_if(points, [](const auto& p) { return std::abs(p[0]) <= 3 && std::abs(p[1]) <= 3; }) == n);
    for (const int axis : {0, 1})
        for (const double share : {0.25, 0.5, 0.9})
            CHECK(std::abs(score(count_if(points, [&](const auto& p) { return p[axis] < 6 * share - 3; }), n, share)) <
                  bound);
    CHECK(std::abs(score(count_if(points, [](const auto& p) { return p[0] * p[1] > 0; }), n, 0.5)) < bound);
}

TEST_CASE("placement: a ring about the first position is filled evenly by area") {
    const auto points = places({{"features.positions", "1 -2"},
                                {"features.placement", "ring"},
                                {"features.count", "8"},
                                {"features.radius_min", "3"},
                                {"features.radius_max", "5"},
                                {"scenario.poses", "2"}},
                               250);
    const int n = static_cast<int>(points.size());
    CHECK(count_if(points, [](const auto& p) { return p.norm() > 3 - 1e-12 && p.norm() < 5 + 1e-12; }) == n);
    CHECK(std::abs(score(count_if(points, [](const auto& p) { return p.squaredNorm() < 17; }), n, 0.5)) < bound);
    for (const double angle : {-2.0, 0.0, 1.0})
        CHECK(std::abs(score(count_if(points, [&](const auto& p) { return std::atan2(p[1], p[0]) < angle; }), n,
                             (angle + M_PI) / (2 * M_PI))) < bound);
}

TEST_CASE("placement: the same places under every arm, others in every trial") {
    const DeformableSettings scenario = scenario_with({{"features.placement", "box"}, {"features.count", "8"}});
    const auto first = [&](Controller controller, std::uint64_t trial) {
        return Eigen::MatrixXd(run_arm(scenario, controller, keyed_noise(scenario, 3, trial)).steps[0].truth);
    };
    CHECK(same_bits(first(Controller::fixed, 1), first(Controller::greedy, 1)));
    CHECK_FALSE(same_bits(first(Controller::fixed, 1), first(Controller::fixed, 2)));
}

TEST_CASE("tails: Student's t has its distribution, and the variance 1") {
    const KeyedDraws<double> draws(1, 0, infinity);
    const int n = 20000;
    // Two-sided quantiles of t with 5 degrees of freedom, scaled to the variance 1.
    for (const auto& [quantile, beyond] : {std::pair{0.7267, 0.5}, {2.0150, 0.1}, {2.5706, 0.05}, {4.0321, 0.01}}) {
        int count = 0;
        for (int i = 0; i < n; ++i) {
            const Vector2<double> t = student_pair(draws.normal(Source::measurement, i, 0), 5);
            count += std::abs(t.x) > quantile * std::sqrt(0.6);
        }
        CHECK(std::abs(score(count, n, beyond)) < bound);
    }
    double squares = 0;
    for (int i = 0; i < n; ++i) squares += squared_norm(student_pair(draws.normal(Source::measurement, i, 0), 9)) / 2;
    // Of t with 9 degrees of freedom the kurtosis is 4.2; both axes share their size, so they count as one.
    CHECK(std::abs(squares / n - 1) < bound * std::sqrt(3.2 / n));
}

TEST_CASE("tails: with many degrees of freedom Student's t is the normal draw") {
    for (const double x : {1e-9, 1e-3, 0.5, 8.0}) {
        const Vector2<double> t = student_pair(Vector2<double>{x, -2 * x}, 1e9);
        CHECK(relative(t.x, x) < 1e-6);
        CHECK(relative(t.y, -2 * x) < 1e-6);
    }
    CHECK(student_pair(Vector2<double>{0, 0}, 3).x == 0);
}

TEST_CASE("gate: of a consistent filter it rejects what it should") {
    // In the matched world each sighting of the first step has nu' S^-1 nu ~ chi-square with two degrees of freedom.
    Settings settings = matched_world();
    settings.insert(settings.end(),
                    {{"model.process", "translation"}, {"filter.gate", "0.9"}, {"scenario.poses", "2"}});
    const DeformableSettings scenario = scenario_with(settings);
    const int trials = 1000;
    int first = 0;
    for (int trial = 0; trial < trials; ++trial)
        first += !run_arm(scenario, Controller::fixed, keyed_noise(scenario, 8, static_cast<std::uint64_t>(trial)))
                      .steps[1].seen[0];
    CHECK(std::abs(score(first, trials, 0.1)) < bound);
}

TEST_CASE("gate: it protects the filter from outliers") {
    const auto mean_nees = [](const char* gate) {
        const DeformableSettings scenario = scenario_with({{"noise.measurement_tails", "contaminated"},
                                                           {"filter.gate", gate},
                                                           {"noise.outlier_scale", "20"},
                                                           {"sensor.sigma", "0.1"}});
        double sum = 0;
        for (std::uint64_t trial = 0; trial < 50; ++trial)
            sum += run_arm(scenario, Controller::fixed, keyed_noise(scenario, 8, trial)).columns[column_nees_ratio];
        return sum / 50;
    };
    CHECK(mean_nees("0.999") < 0.6 * mean_nees("1"));
}

TEST_CASE("bias: without other noise the robot strays by it at each step, in its own frame") {
    const DeformableSettings scenario = scenario_with({{"noise.odometry_bias", "0.3"}, {"features.path", "circle"}});
    const AnyNoise noise = with_draw(silent_noise(), Source::odometry_bias, 0, 0, {1, -2});
    const auto truth = [&](const AnyNoise& draws, std::size_t k) {
        return Eigen::Vector3d(run_arm(scenario, Controller::fixed, draws).steps[k].truth.head<3>());
    };
    Eigen::Vector2d strayed(0, 0);
    for (std::size_t k = 1; k < 6; ++k) {
        const double heading = truth(noise, k - 1)[0];
        strayed += Eigen::Rotation2Dd(heading) * Eigen::Vector2d(0.3, -0.6);
        CHECK((truth(noise, k).tail<2>() - truth(silent_noise(), k).tail<2>() - strayed).norm() < 1e-13);
    }
}

TEST_CASE("every: features are seen at every third pose only, and edges at all") {
    const DeformableSettings scenario =
        scenario_with({{"sensor.every", "3"}, {"sensor.range_max", "inf"}, {"sensor.range_min", "0"}});
    const Run run = run_arm(scenario, Controller::greedy, keyed_noise(scenario, 1, 1));
    for (int k = 1; k < scenario.poses; ++k) {
        CHECK(run.figure("nis_rows", k) == (k % 3 == 0 ? 12 : 6));
        CHECK(run.figure("unseen_features", k) == (k % 3 == 0 ? 0 : 3));
    }
}

}  // namespace credence::test::disturbances_test
