// The controllers that do not plan [docs/model.md, Controllers].

#include "catch.hpp"
#include "support.hpp"

#include "slam/trial/problem.hpp"
#include <credence/text.hpp>

#include <cmath>
#include <map>

namespace credence::test::baselines_test {

namespace {

const std::string corner = "6 0, 6 6, 0 6";

DeformableSettings steered(Settings settings) {
    settings.insert(settings.end(), {{"arms.controllers", "fixed, random, nearest, follow, waypoints"}});
    bool has_path = false;
    for (const auto& [key, value] : settings) has_path = has_path || key == "control.waypoints";
    if (!has_path) settings.emplace_back("control.waypoints", corner);
    return scenario_with(settings);
}

double apart(const Control& a, const Control& b) {
    return std::abs(a.turn - b.turn) + std::hypot(a.move.x - b.move.x, a.move.y - b.move.y);
}

}  // namespace

TEST_CASE("baselines: every controller steers as the oracle's") {
    for (const Settings& cell : seed_cells())
        for (const Controller controller : {Controller::random, Controller::nearest, Controller::follow,
                                            Controller::waypoints})
            for (std::uint64_t trial = 0; trial < 5; ++trial) {
                Settings settings = cell;
                settings.emplace_back("features.sway_amplitude", "0.3");
                const DeformableSettings scenario = steered(settings);
                const AnyNoise noise = keyed_noise(scenario, 5, trial);
                const Run ours = run_arm(scenario, controller, noise);
                const Difference worst = difference(ours, oracle::run(scenario, controller, for_oracle(noise)));
                CAPTURE(described(settings), static_cast<int>(controller), trial);
                CHECK(worst.same_control);
                CHECK(worst.same_sight);
                CHECK(worst.mean < 1e-10);  // cond(S) is below 1e5: 12 rows * 1e5 * 2^-53
                CHECK(worst.covariance < 1e-10);
            }
}

TEST_CASE("baselines: a random control is each candidate equally often, whatever the other draws are") {
    const DeformableSettings scenario = steered({{"planner.speeds", "1"}});  // three candidates
    std::map<double, int> taken;
    const int trials = 400;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        const Run run = run_arm(scenario, Controller::random, keyed_noise(scenario, 11, trial));
        for (int k = 1; k < scenario.poses; ++k) ++taken[run.steps[static_cast<std::size_t>(k)].control.move.x];
    }
    REQUIRE(taken.size() == 3);
    const double draws = trials * 19.0;
    for (const auto& [move, count] : taken)  // 4.5 standard deviations: a false alarm once in 50,000 runs
        CHECK(std::abs(count - draws / 3) < 4.5 * std::sqrt(draws * 2 / 9));
}

TEST_CASE("baselines: all controllers share the features' truth") {
    const DeformableSettings scenario = steered({{"features.path", "circle"}});
    const AnyNoise noise = keyed_noise(scenario, 5, 3);
    const Eigen::VectorXd fixed = run_arm(scenario, Controller::fixed, noise).steps.back().truth.tail(6);
    for (const Controller controller :
         {Controller::random, Controller::nearest, Controller::follow, Controller::waypoints})
        CHECK(same_bits(Eigen::MatrixXd(run_arm(scenario, controller, noise).steps.back().truth.tail(6)), fixed));
}

TEST_CASE("baselines: follow is at the predicted centre of the features, as far as the longest candidate reaches") {
    for (const char* process : {"heading", "translation"}) {
        const Settings still{{"model.process", process}, {"features.path", "static"}, {"control.path", "circle"}};
        Settings far = still;
        far.emplace_back("features.positions", "30 40, 30 40");
        const int at = process == std::string("heading") ? 1 : 0;
        const auto first = [&](const Settings& settings) {
            return Eigen::Vector2d(
                run_arm(steered(settings), Controller::follow, silent_noise()).steps[1].truth.segment<2>(at));
        };
        CHECK((first(still) - Eigen::Vector2d(1.7 / 3, 1.7 / 3)).norm() < 1e-14);
        const double reach = at == 1 ? 4 : 2 * std::sqrt(2.0);  // 2 d ahead, or d in both axes
        CHECK((first(far) - reach * Eigen::Vector2d(0.6, 0.8)).norm() < 1e-14);
    }
}

TEST_CASE("baselines: nearest goes to the feature with the largest variance") {
    const DeformableSettings scenario =
        steered({{"sensor.noise", "ranged"}, {"features.path", "static"}, {"features.positions", "0.5 0, 0 1.5, 1 0"}});
    const Run run = run_arm(scenario, Controller::nearest, silent_noise());
    CHECK(apart(run.steps[1].control, {M_PI / 2, {0, 1.5}}) < 1e-14);  // the farthest was measured worst
}

TEST_CASE("baselines: a robot that is where it is steered to does not turn by rounding") {
    // Between two uses of the sensor the robot is at the features' centre, and they sway about places that stay.
    const DeformableSettings scenario = steered({{"features.sway_amplitude", "0.8"}, {"features.path", "static"},
                                                 {"sensor.every", "10"}, {"scenario.poses", "10"},
                                                 {"control.waypoints", "0.1 0, 0.3 0, 0.3 0.3"},
                                                 {"features.step", "0.1"}});
    for (const Controller controller : {Controller::follow, Controller::nearest, Controller::waypoints})
        for (std::uint64_t trial = 0; trial < 20; ++trial) {
            const Run run = run_arm(scenario, controller, keyed_noise(scenario, 5, trial));
            for (std::size_t k = 1; k < run.steps.size(); ++k) {
                const Control& control = run.steps[k].control;
                CAPTURE(static_cast<int>(controller), trial, k, control.turn, control.move.x, control.move.y);
                const double way = std::hypot(control.move.x, control.move.y);
                CHECK((way == 0 ? control.turn == 0 : way > 1e-9));
            }
        }
}

TEST_CASE("baselines: nearest goes to the first of the features whose variances are the largest but for 1e-12") {
    // Each is 0.9e-12 above the one before: the first is not among the equals of the last.
    const auto sigma = [](double excess) { return to_text(0.05 * std::sqrt(1 + excess)); };
    const DeformableSettings scenario =
        steered({{"model.process", "translation"}, {"features.path", "static"}, {"sensor.noise", "ranged"},
                 {"sensor.sigma_near", sigma(0)}, {"sensor.sigma_far", sigma(1.9e-12)},
                 {"features.positions", "0.1 0, 0 1.05, 2 0"}});
    CHECK(run_arm(scenario, Controller::nearest, silent_noise()).steps[1].control.move.y > 1);
}

TEST_CASE("baselines: without noise waypoints lead along their path at the step length, and end at the last") {
    for (const char* process : {"heading", "translation"}) {
        const DeformableSettings scenario = steered({{"model.process", process}, {"control.waypoints", "3 0, 3 3"}});
        const Run run = run_arm(scenario, Controller::waypoints, silent_noise());
        const int at = process == std::string("heading") ? 1 : 0;
        const std::vector<Eigen::Vector2d> places{{0, 0}, {2, 0}, {3, 1}, {3, 3}, {3, 3}, {3, 3}};
        for (std::size_t k = 0; k < places.size(); ++k)
            CHECK((run.steps[k].truth.segment<2>(at) - places[k]).norm() < 1e-14);
        // The heading is that of the last move.
        if (at == 1) CHECK(std::abs(run.steps[5].truth[0] - M_PI / 2) < 1e-14);
    }
}

TEST_CASE("baselines: no candidates are priced where none are needed") {
    const DeformableSettings scenario = steered({});
    for (const Controller controller :
         {Controller::random, Controller::nearest, Controller::follow, Controller::waypoints})
        CHECK(run_arm(scenario, controller, silent_noise()).steps[1].candidate_cost.empty());
}

}  // namespace credence::test::baselines_test
