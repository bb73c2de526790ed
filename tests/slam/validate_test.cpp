// Combinations of keys that are refused, and the defaults that depend on other keys.

#include "catch.hpp"
#include "support.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/keys.hpp"

#include <cmath>

namespace credence::test::validate_test {

namespace {

struct Contradiction {
    Settings settings;
    std::string key;  ///< that the refusal names
};

}  // namespace

TEST_CASE("scenario: keys that contradict each other are refused, naming one of them") {
    const std::vector<Contradiction> contradictions{
        {{{"sensor.range_min", "2"}}, "sensor.range_max"},
        {{{"sensor.range_min", "3"}}, "sensor.range_max"},
        {{{"sensor.sigma", "0"}}, "sensor.sigma"},
        {{{"sensor.noise", "ranged"}, {"sensor.range_max", "inf"}}, "sensor.range_max"},
        {{{"sensor.noise", "ranged"}, {"sensor.sigma_near", "0"}}, "sensor.sigma_near"},
        {{{"sensor.noise", "ranged"}, {"sensor.sigma_far", "0.005"}}, "sensor.sigma_far"},
        {{{"noise.heading", "0"}}, "noise.heading"},
        {{{"filter.heading", "0"}}, "filter.heading"},
        {{{"noise.odometry", "0"}}, "noise.odometry"},
        {{{"filter.odometry", "0"}}, "filter.odometry"},
        {{{"noise.deformation", "0"}}, "noise.deformation"},
        {{{"filter.edges", "0"}}, "filter.edges"},
        {{{"filter.measurement", "0"}}, "filter.measurement"},
        {{{"filter.covariance", "0"}}, "filter.covariance"},
        {{{"model.process", "translation"}, {"noise.initial_heading", "0.1"}}, "noise.initial_heading"},
        {{{"edges.graph", "0-3"}}, "edges.graph"},
        {{{"features.placement", "box"}, {"features.count", "2"}, {"edges.graph", "1-2"}}, "edges.graph"},
        {{{"features.count", "4"}}, "features.count"},
        {{{"features.placement", "ring"}, {"features.radius_min", "3"}}, "features.radius_max"},
        {{{"edges.graph", "1-2"}, {"features.positions", "1 1, 2 2"}}, "edges.graph"},
        {{{"planner.turns", "none"}}, "planner.turns"},
        {{{"model.process", "translation"}, {"planner.turns", "0"}}, "planner.turns"},
        {{{"planner.horizon", "2"}}, "planner.horizon"},
        {{{"arms.controllers", "waypoints"}}, "arms.controllers"},
        {{{"control.waypoints", "1 1"}}, "control.waypoints"},
        {{{"arms.controllers", "horizon"}, {"features.path", "circle"}, {"planner.horizon", "4"}}, "planner.horizon"},
        {{{"arms.estimators", "kf"}}, "arms.estimators"},
        {{{"arms.estimators", "ekf, kf"}}, "arms.estimators"},
        {{{"model.process", "translation"}, {"arms.estimators", "ekf"}}, "arms.estimators"},
        {{{"published.trace_P", "best 0.1"}}, "published.trace_P"},
        {{{"published.unseen", "greedy 3"}}, "published.unseen"},
        {{{"published.pose_error", "ekf.fixed 3"}}, "published.pose_error"},
    };
    for (const Contradiction& one : contradictions) {
        CAPTURE(described(one.settings));
        const std::string message = refusal([&] { scenario_with(one.settings); });
        CHECK(message.starts_with("invalid " + one.key + "="));
        CHECK(message.ends_with("."));
        CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("scenario: what only looks like a contradiction is taken") {
    const std::vector<Settings> fine{
        {},
        {{"sensor.sigma", "0"}, {"sensor.noise", "ranged"}},
        {{"sensor.sigma_near", "0"}},
        {{"sensor.sigma_far", "0"}},
        {{"sensor.noise", "ranged"}, {"sensor.sigma_far", "0.01"}},
        {{"sensor.range_max", "inf"}, {"sensor.range_min", "0"}},
        {{"noise.heading", "0"}, {"noise.initial_heading", "0.1"}},
        {{"noise.heading", "0"}, {"model.process", "translation"}},
        {{"filter.heading", "0"}, {"model.process", "translation"}},
        {{"noise.odometry", "0"}, {"noise.initial_position", "0.1"}},
        {{"noise.deformation", "0"}, {"edges.graph", "none"}},
        {{"filter.edges", "0"}, {"edges.graph", "none"}},
        {{"noise.deformation", "0"}, {"features.positions", "1 1"}},
        {{"noise.walk", "0"}},
        {{"filter.features", "0"}},
        {{"sensor.detection", "0"}},
        {{"features.count", "3"}},
        {{"features.placement", "box"}, {"features.count", "8"}, {"edges.graph", "0-7"}},
        {{"features.placement", "box"}, {"features.radius_min", "3"}},
        {{"features.placement", "ring"}, {"features.radius_min", "2"}},
        {{"features.path", "static"}, {"control.path", "circle"}},
        {{"planner.turns", "none"}, {"model.process", "translation"}},
        {{"arms.estimators", "ekf"}},
        {{"arms.estimators", "kf"}, {"model.process", "translation"}},
        {{"published.trace_P", "fixed.kf 0.1, greedy.ekf 0.2"}},
    };
    for (const Settings& settings : fine) CHECK(refusal([&] { scenario_with(settings); }) == "");
}

TEST_CASE("scenario: what depends on the process and the path is filled in") {
    const DeformableSettings straight = scenario_with({});
    CHECK(straight.planner.speeds == 10);
    CHECK(straight.planner.turns == std::vector<double>{0});
    CHECK(straight.arms.estimators == std::vector{Estimator::ekf});
    const DeformableSettings circle = scenario_with({{"features.path", "circle"}});
    REQUIRE(circle.planner.turns->size() == 6);
    for (std::size_t m = 0; m < 6; ++m)  // -pi/4 + m pi/10, by other roundings
        CHECK(std::abs((*circle.planner.turns)[m] - M_PI * (-0.25 + 0.1 * static_cast<double>(m))) < 1e-15);
    CHECK(scenario_with({{"features.path", "static"}}).planner.turns->size() == 6);
    CHECK(scenario_with({{"features.path", "circle"}, {"control.path", "straight"}}).planner.turns->size() == 1);
    CHECK(scenario_with({{"control.path", "circle"}}).planner.turns->size() == 6);
    CHECK(scenario_with({{"features.path", "circle"}, {"features.turn", "0.1"}}).planner.turns == circle.planner.turns);
    const DeformableSettings translation =
        scenario_with({{"model.process", "translation"}, {"features.path", "circle"}});
    CHECK(translation.planner.speeds == 5);
    CHECK(translation.planner.turns->empty());
    CHECK(translation.arms.estimators == std::vector{Estimator::kf});
}

TEST_CASE("scenario: what was given stays when the rest is filled in, and filling in twice changes nothing") {
    const Settings given{{"planner.speeds", "3"}, {"planner.turns", "0.5"}, {"features.path", "circle"}};
    const DeformableSettings once = scenario_with(given);
    CHECK(once.planner.speeds == 3);
    CHECK(once.planner.turns == std::vector{0.5});
    CHECK(scenario_text(resolved(once)) == scenario_text(once));
}

TEST_CASE("scenario: arms are controllers outer, estimators inner, with their names") {
    const auto names = [](const Settings& settings) {
        std::vector<std::string> list;
        for (const Arm& arm : arms_of(scenario_with(settings))) list.push_back(arm_name(scenario_with(settings), arm));
        return list;
    };
    CHECK(names({}) == std::vector<std::string>{"fixed.ekf", "greedy.ekf"});
    CHECK(names({{"model.process", "translation"}}) == std::vector<std::string>{"fixed.kf", "greedy.kf"});
    CHECK(names({{"arms.controllers", "greedy, fixed"}}) == std::vector<std::string>{"greedy.ekf", "fixed.ekf"});
    CHECK(names({{"arms.controllers", "greedy"}}) == std::vector<std::string>{"greedy.ekf"});
}

TEST_CASE("scenario: graphs have their edges in order") {
    const auto edges = [](const char* graph, const char* positions) {
        return edge_list(scenario_with({{"features.positions", positions}, {"edges.graph", graph}}));
    };
    const char* four = "0 0, 1 1, 2 2, 3 3";
    CHECK(edges("all", four) == std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}});
    CHECK(edges("chain", four) == std::vector<Edge>{{0, 1}, {1, 2}, {2, 3}});
    CHECK(edges("2-3, 0-1", four) == std::vector<Edge>{{2, 3}, {0, 1}});
    CHECK(edges("none", four).empty());
    CHECK(edges("all", "0 0").empty());
    CHECK(edges("chain", "0 0").empty());
}

TEST_CASE("scenario: the state has the pose's and the features' components") {
    CHECK(state_size(scenario_with({})) == 9);
    CHECK(pose_size(scenario_with({})) == 3);
    const DeformableSettings translation =
        scenario_with({{"model.process", "translation"}, {"features.positions", "1 1"}});
    CHECK(state_size(translation) == 4);
    CHECK(pose_size(translation) == 2);
}

TEST_CASE("scenario: an unknown key is refused with the closest known one") {
    const auto message = [](const std::string& key) {
        DeformableSettings scenario;
        return refusal([&] { set_key(scenario, key, "1"); });
    };
    CHECK(message("noise.heding") == "unknown key noise.heding. Did you mean noise.heading?");
    CHECK(message("scenario.pose").find("scenario.poses") != std::string::npos);
    CHECK(message("zzz") == "unknown key zzz. `credence show` prints every key.");
    CHECK(message("Noise.heading").find("noise.heading") != std::string::npos);
}

TEST_CASE("scenario: a refusal is one line, whatever was given") {
    std::vector<std::string> torn;
    for (const DeformableKey& key : scenario_keys()) {
        DeformableSettings scenario;
        if (refusal([&] { set_key(scenario, key.name, "1\n2"); }).find('\n') != std::string::npos)
            torn.push_back(key.name);
    }
    CHECK(torn == std::vector<std::string>{});
}

}  // namespace credence::test::validate_test
