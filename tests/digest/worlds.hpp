#pragma once
// The small study of the digest: worlds that together reach every branch of the equations.

#include "../landmark_loop.hpp"

#include <string>
#include <utility>
#include <vector>

namespace credence::digest {

/// Name of a world, and values by key, set in order on the default scenario.
struct World {
    std::string name;
    std::vector<std::pair<std::string, std::string>> settings;
};

/// The eight cells of the reference study; the other worlds are shorter, since an emulator computes them as well.
inline std::vector<World> seed_worlds() {
    std::vector<World> cells;
    for (const std::string process : {"heading", "translation"})
        for (const std::string path : {"straight", "circle"})
            for (const std::string noise : {"constant", "ranged"})
                cells.push_back({process + "-" + path + "-" + noise,
                                 {{"model.process", process},
                                  {"features.path", path},
                                  {"sensor.noise", noise},
                                  {"scenario.poses", path == "circle" ? "10" : "20"}}});
    return cells;
}

inline const std::string two = "1 1, -0.5 0.3", five = "1 1, 0 1, 1 0, -1 0, 0.5 0.5",
                         eight = five + ", -0.3 0.7, 0.2 -0.9, -0.8 -0.4";

/// Numbers of features and graphs of edges: written out and rolled loops, contrasts of every kind.
inline std::vector<World> graph_worlds() {
    return {
        {"one-feature", {{"features.positions", "1 1"}}},
        {"one-feature-translation",
         {{"features.positions", "1 1"}, {"model.process", "translation"}, {"sensor.noise", "ranged"}}},
        {"two-features-list", {{"features.positions", two}, {"edges.graph", "0-1"}, {"sensor.noise", "ranged"}}},
        {"three-features-no-edges", {{"edges.graph", "none"}, {"sensor.noise", "ranged"}}},
        {"three-features-list", {{"edges.graph", "0-2, 1-2"}, {"model.process", "translation"}}},
        {"five-features-chain",
         {{"features.positions", five},
          {"edges.graph", "chain"},
          {"model.process", "translation"},
          {"sensor.noise", "ranged"}}},
        {"eight-features", {{"features.positions", eight}, {"scenario.poses", "5"}}},
        {"eight-features-no-edges",
         {{"features.positions", eight}, {"edges.graph", "none"}, {"scenario.poses", "5"}, {"sensor.noise", "ranged"}}},
    };
}

/// Noise, truth and filter away from their defaults.
inline std::vector<World> noise_worlds() {
    return {
        {"detection-truncate-sway",
         {{"sensor.detection", "0.5"}, {"noise.truncate", "2"}, {"features.sway_amplitude", "0.5"}}},
        {"walk-independent-infinite",
         {{"truth.deformation", "walk"}, {"truth.edge_noise", "independent"}, {"sensor.range_max", "inf"}}},
        {"uncertain-start-static",
         {{"noise.initial_heading", "0.1"}, {"noise.initial_position", "0.1"}, {"features.path", "static"}}},
        {"large-heading-noise",
         {{"noise.heading", "0.05"},
          {"features.path", "circle"},
          {"sensor.noise", "ranged"},
          {"arms.controllers", "greedy"}}},
        {"tiny-heading-noise", {{"noise.heading", "1e-9"}, {"features.path", "circle"}, {"sensor.noise", "ranged"}}},
        {"factors",
         {{"filter.heading", "2"},
          {"filter.odometry", "0.5"},
          {"filter.features", "3"},
          {"filter.measurement", "0.7"},
          {"filter.edges", "1.5"},
          {"filter.covariance", "4"},
          {"control.path", "circle"}}},
        {"other-candidates", {{"planner.speeds", "2"}, {"planner.turns", "-0.4, 0, 0.25"}, {"sensor.noise", "ranged"}}},
        {"many-candidates-translation",
         {{"model.process", "translation"}, {"features.path", "circle"}, {"planner.speeds", "7"}}},
        {"five-features-translation",
         {{"features.positions", five}, {"model.process", "translation"}, {"features.path", "circle"}}},
    };
}

/// Arms beyond those of every world: the other estimators, the other controllers and criteria.
inline std::vector<World> arm_worlds() {
    const std::string few = "-0.4, 0.25";
    return {
        {"estimators",
         {{"arms.estimators", "ekf, ideal, fej, riekf, iekf"},
          {"arms.controllers", "fixed"},
          {"noise.heading", "0.02"},
          {"features.path", "circle"},
          {"scenario.poses", "6"}}},
        {"horizon",
         {{"arms.controllers", "horizon"},
          {"planner.horizon", "3"},
          {"planner.speeds", "1"},
          {"planner.turns", few},
          {"sensor.noise", "ranged"},
          {"scenario.poses", "6"}}},
        {"horizon-translation",
         {{"arms.controllers", "horizon"},
          {"model.process", "translation"},
          {"features.path", "circle"},
          {"planner.speeds", "1"},
          {"scenario.poses", "5"}}},
        {"baselines",
         {{"arms.controllers", "random, nearest, follow, waypoints"},
          {"control.waypoints", "3 0, 3 3"},
          {"features.path", "circle"}}},
        {"pose-trace",
         {{"arms.controllers", "greedy"},
          {"planner.criterion", "pose_trace"},
          {"planner.heading_weight", "4"},
          {"features.path", "circle"},
          {"sensor.noise", "ranged"}}},
        {"log-det", {{"arms.controllers", "greedy"}, {"planner.criterion", "log_det"}, {"planner.turns", few}}},
        {"max-eigenvalue",
         {{"arms.controllers", "greedy"}, {"planner.criterion", "max_eigenvalue"}, {"planner.turns", few}}},
    };
}

/// Features that are placed, noise with tails, and what else disturbs a filter.
inline std::vector<World> disturbed_worlds() {
    return {
        {"ring-student-gate",
         {{"features.placement", "ring"},
          {"features.count", "4"},
          {"noise.measurement_tails", "student"},
          {"filter.gate", "0.9"},
          {"sensor.every", "2"}}},
        {"box-contaminated-bias",
         {{"features.placement", "box"},
          {"model.process", "translation"},
          {"noise.measurement_tails", "contaminated"},
          {"noise.odometry_bias", "0.1"}}},
    };
}

/// Trials that fail beside others that do not, and P beyond 1e12.
inline std::vector<World> fragile_worlds() {
    return {
        {"failing", {{"noise.odometry", "1e5"}, {"sensor.range_max", "inf"}, {"arms.controllers", "fixed"}}},
        {"diverging",
         {{"noise.odometry", "2e6"},
          {"sensor.sigma", "100"},
          {"sensor.range_max", "inf"},
          {"sensor.detection", "0.5"}}},
    };
}

/// Landmarks on a loop, walked a little more than once, with every estimator.
inline ExploreSettings small_loop() {
    ExploreSettings settings = test::landmark_loop(10, {7, 1, 5, 0.5});
    settings.prior = 2;
    settings.sensor.range_max = 1.2;
    return resolved(settings);
}

/// Landmarks that are discovered among walls, with every controller.
inline ExploreSettings small_rooms() {
    ExploreSettings settings;
    settings.name = "explore";
    settings.poses = 10;
    settings.walls = {{{-1, 1}, {2, 1}}, {{2, 1}, {2, -2}}};
    settings.features.count = 5;
    settings.features.extent = 6;
    settings.sensor.range_max = 3;
    settings.view = 2.5;
    settings.box = {{-3, -3}, {3, 3}};
    settings.coverage = 0.01;
    settings.explorers = {Explorer::fixed, Explorer::random, Explorer::frontier, Explorer::greedy, Explorer::informed};
    settings.arms.estimators = std::vector{Estimator::ekf, Estimator::fej};
    return resolved(settings);
}

/// The default number of poses of the worlds that do not set their own.
inline const std::string short_poses = "8";

}  // namespace credence::digest
