// Every key of a scenario does what it says: changing it changes the figure that it should, and the changed scenario
// agrees with the oracle, on the fixed and on the planned path.

#include "catch.hpp"
#include "support.hpp"

#include "worlds/deformable/keys.hpp"

#include <set>

namespace credence::test::keys_test {

namespace {

enum class Way { up, down };

struct Influence {
    std::string key, value;
    Settings base;                       ///< what else must be set for the key to matter
    Controller controller;               ///< whose column
    ColumnIndex column;                  ///< that changes
    Way way;                             ///< where the mean over the trials goes
    std::vector<ColumnIndex> untouched;  ///< the same bits for every trial
};

constexpr Controller fixed = Controller::fixed, greedy = Controller::greedy, horizon = Controller::horizon,
                     waypoints = Controller::waypoints;
const Settings circle{{"features.path", "circle"}}, ranged{{"sensor.noise", "ranged"}},
    swaying{{"features.sway_amplitude", "0.8"}}, turning{{"noise.heading", "0.02"}},
    flat{{"model.process", "translation"}}, far{{"sensor.sigma_far", "0.5"}},
    turned{{"noise.heading", "0.05"}, {"features.path", "circle"}}, boxed{{"features.placement", "box"}},
    ringed{{"features.placement", "ring"}}, coarse{{"sensor.sigma", "0.5"}, {"noise.degrees_of_freedom", "2.1"}},
    tailed{{"sensor.sigma", "0.5"}, {"noise.degrees_of_freedom", "2.1"}, {"noise.measurement_tails", "student"}},
    soiled{{"sensor.sigma", "0.5"}, {"noise.measurement_tails", "contaminated"}},
    walked{{"arms.controllers", "waypoints"}, {"control.waypoints", "2 0, 40 0"}},
    ahead{
        {"model.process", "translation"}, {"features.path", "circle"}, {"arms.controllers", "fixed, greedy, horizon"}};
const std::vector<ColumnIndex> sight{column_unseen}, beliefs{column_unseen, column_trace_P},
    all{column_trace_P, column_unseen, column_pose_error, column_nees_ratio, column_nis_ratio},
    all_but_reported{column_unseen, column_pose_error, column_nis_ratio};

const std::vector<Influence>& influences() {
    static const std::vector<Influence> list{
        {"scenario.poses", "12", {}, fixed, column_unseen, Way::down, {}},
        {"model.process", "translation", turning, fixed, column_trace_P, Way::down, {}},
        {"features.positions", "0.5 0.5, 3 3", {}, fixed, column_unseen, Way::up, {}},
        {"features.count", "8", boxed, fixed, column_unseen, Way::up, {}},
        {"features.placement", "box", {}, fixed, column_unseen, Way::up, {}},
        {"features.placement", "ring", {}, fixed, column_unseen, Way::up, {}},
        {"features.extent", "6", boxed, fixed, column_unseen, Way::up, {}},
        {"features.radius_min", "1.9", ringed, fixed, column_unseen, Way::up, {}},
        {"features.radius_max", "5", ringed, fixed, column_unseen, Way::up, {}},
        {"features.path", "circle", {}, fixed, column_unseen, Way::up, {}},
        {"features.path", "static", turning, fixed, column_trace_P, Way::down, {}},
        {"features.step", "0.1", circle, fixed, column_unseen, Way::down, {}},
        {"features.turn", "0.05", circle, fixed, column_unseen, Way::down, {}},
        {"features.sway_amplitude", "3", {}, fixed, column_unseen, Way::up, {}},
        {"features.sway_period", "1", swaying, fixed, column_unseen, Way::down, {}},
        {"sensor.range_min", "0.6", {}, fixed, column_unseen, Way::up, {}},
        {"sensor.range_max", "1", {}, fixed, column_unseen, Way::up, {}},
        {"sensor.noise", "ranged", far, fixed, column_trace_P, Way::up, sight},
        {"sensor.sigma", "0.1", {}, fixed, column_trace_P, Way::up, sight},
        {"sensor.sigma_near", "0.09", ranged, fixed, column_trace_P, Way::up, sight},
        {"sensor.sigma_far", "0.3", ranged, fixed, column_trace_P, Way::up, sight},
        {"sensor.detection", "0.5", {}, fixed, column_unseen, Way::up, {}},
        {"sensor.every", "2", {}, fixed, column_unseen, Way::up, {}},
        {"noise.heading", "0.05", {}, fixed, column_trace_P, Way::up, {}},
        {"noise.odometry", "0.1", {}, fixed, column_trace_P, Way::up, {}},
        {"noise.walk", "0.6", {}, fixed, column_unseen, Way::up, {}},
        {"noise.deformation", "0.4", {}, fixed, column_trace_P, Way::up, {}},
        {"noise.initial_heading", "0.1", {}, fixed, column_pose_error, Way::up, {}},
        {"noise.initial_position", "0.2", {}, fixed, column_pose_error, Way::up, {}},
        {"noise.odometry_bias", "0.1", {}, fixed, column_pose_error, Way::up, {}},
        {"noise.measurement_tails", "student", coarse, fixed, column_nees_ratio, Way::down, {}},
        {"noise.measurement_tails", "contaminated", coarse, fixed, column_nees_ratio, Way::up, {}},
        {"noise.degrees_of_freedom", "100", tailed, fixed, column_nees_ratio, Way::up, {}},
        {"noise.outlier_share", "0.5", soiled, fixed, column_nees_ratio, Way::up, {}},
        {"noise.outlier_scale", "10", soiled, fixed, column_nees_ratio, Way::up, {}},
        {"noise.truncate", "0.5", {}, fixed, column_unseen, Way::down, {}},
        {"truth.deformation", "walk", {}, fixed, column_unseen, Way::up, {}},
        {"truth.edge_noise", "independent", flat, fixed, column_nis_ratio, Way::up, beliefs},
        {"edges.graph", "chain", {}, fixed, column_trace_P, Way::up, sight},
        {"edges.graph", "none", {}, fixed, column_trace_P, Way::up, sight},
        {"edges.graph", "0-2", {}, fixed, column_trace_P, Way::up, sight},
        {"filter.heading", "3", turning, fixed, column_trace_P, Way::up, sight},
        {"filter.odometry", "0.5", {}, fixed, column_trace_P, Way::down, sight},
        {"filter.features", "0.5", {}, fixed, column_trace_P, Way::down, sight},
        {"filter.measurement", "0.5", {}, fixed, column_nees_ratio, Way::up, sight},
        {"filter.edges", "2", {}, fixed, column_trace_P, Way::up, sight},
        {"filter.covariance", "2", {}, fixed, column_trace_P, Way::up, all_but_reported},
        {"filter.covariance", "2", circle, greedy, column_nees_ratio, Way::down, all_but_reported},
        {"filter.gate", "0.5", {}, fixed, column_unseen, Way::up, {}},
        {"control.path", "circle", {}, fixed, column_unseen, Way::up, {}},
        {"control.path", "straight", circle, greedy, column_unseen, Way::up, {}},
        {"planner.speeds", "1", {}, greedy, column_unseen, Way::up, {}},
        {"planner.speeds", "1", {}, fixed, column_count, Way::up, all},
        {"planner.turns", "0", circle, greedy, column_trace_P, Way::up, {}},
        {"planner.turns", "0.1, 0.2", circle, fixed, column_count, Way::up, all},
        {"control.waypoints", "0 9", walked, waypoints, column_unseen, Way::up, {}},
        {"planner.criterion", "pose_trace", circle, greedy, column_unseen, Way::up, {}},
        {"planner.criterion", "pose_log_det", circle, fixed, column_count, Way::up, all},
        {"planner.heading_weight", "100", turned, greedy, column_pose_error, Way::up, {}},
        {"planner.horizon", "1", ahead, horizon, column_trace_P, Way::up, {}},
        // What the filter believes steers the planner too.
        {"filter.measurement", "0.2", circle, greedy, column_nees_ratio, Way::up, {}},
        {"sensor.range_max", "0.7", circle, greedy, column_unseen, Way::up, {}},
    };
    return list;
}

/// Keys that change no column: names, and settings that are only shown or select among arms
/// (tests/engine/block_test.cpp).
const std::set<std::string> silent_keys{"scenario.name",    "scenario.title",      "scenario.length_unit",
                                        "arms.controllers", "arms.estimators",     "published.trace_P",
                                        "published.unseen", "published.pose_error"};

constexpr std::uint64_t trials = 20;

std::vector<std::vector<double>> columns_of(const DeformableSettings& scenario, Controller controller) {
    std::vector<std::vector<double>> columns;
    for (std::uint64_t trial = 0; trial < trials; ++trial)
        columns.push_back(run_arm(scenario, controller, keyed_noise(scenario, 77, trial)).columns);
    return columns;
}

double mean(const std::vector<std::vector<double>>& columns, ColumnIndex column) {
    double sum = 0;
    for (const auto& trial : columns) sum += trial[column];
    return sum / static_cast<double>(columns.size());
}

Settings with_change(const Influence& influence) {
    Settings settings = influence.base;
    settings.emplace_back(influence.key, influence.value);
    return settings;
}

}  // namespace

TEST_CASE("keys: every key is known to change a column, or known to change none") {
    std::set<std::string> covered = silent_keys, present;
    for (const Influence& influence : influences()) covered.insert(influence.key);
    for (const DeformableKey& key : scenario_keys())
        if (!key.hidden) present.insert(key.name);  // those of a budget have tests of their own
    CHECK(covered == present);
}

TEST_CASE("keys: changing a key changes the column that it should, in its direction, and no other that it should not") {
    for (const Influence& influence : influences()) {
        CAPTURE(described(influence.base), influence.key, influence.value);
        const auto before = columns_of(scenario_with(influence.base), influence.controller);
        const auto after = columns_of(scenario_with(with_change(influence)), influence.controller);
        if (influence.column != column_count) {
            const double from = mean(before, influence.column), to = mean(after, influence.column);
            // Twenty trials on the same draws; every one of these effects is larger than a twentieth.
            CHECK((influence.way == Way::up ? to - from : from - to) > 0.05 * std::abs(from));
        }
        for (const ColumnIndex column : influence.untouched)
            for (std::size_t trial = 0; trial < trials; ++trial)
                CHECK(same_bits(before[trial][column], after[trial][column]));
    }
}

TEST_CASE("keys: every changed scenario agrees with the oracle on both paths") {
    for (const Influence& influence : influences())
        for (const Controller controller : {fixed, greedy})
            for (std::uint64_t trial = 0; trial < 2; ++trial) {
                const DeformableSettings scenario = scenario_with(with_change(influence));
                const AnyNoise noise = keyed_noise(scenario, 78, trial);
                const Run ours = run_arm(scenario, controller, noise);
                const Difference worst = difference(ours, oracle::run(scenario, controller, for_oracle(noise)));
                CAPTURE(described(with_change(influence)), static_cast<int>(controller), trial);
                CHECK(worst.same_sight);
                CHECK(worst.same_control);
                CHECK(worst.same_rows);
                CHECK(worst.same_unseen);
                // cond(S) is below 1e4 in all of these: 12 rows * 1e4 * 2^-53 = 1.3e-11 of P^-.
                CHECK(worst.condition < 1e4);
                CHECK(worst.mean < 1e-11);
                CHECK(worst.covariance < 1e-11);
                CHECK(std::max({worst.trace_P, worst.nees, worst.nis, worst.cost}) < 1e-9);
                CHECK(std::max({worst.pose_error, worst.nees_ratio, worst.nis_ratio}) < 1e-9);
            }
}

TEST_CASE("keys: names, titles, units and published values change no bit") {
    const DeformableSettings plain = scenario_with({});
    const DeformableSettings named = scenario_with({{"scenario.name", "other"},
                                                    {"scenario.title", "Other"},
                                                    {"scenario.length_unit", "m"},
                                                    {"arms.controllers", "greedy"},
                                                    {"planner.horizon", "1"},
                                                    {"published.trace_P", "fixed.ekf 0.1"},
                                                    {"published.unseen", "fixed.ekf 3"},
                                                    {"published.pose_error", "fixed.ekf 0.2"}});
    for (const Controller controller : {fixed, greedy}) {
        const auto before = columns_of(plain, controller), after = columns_of(named, controller);
        for (std::size_t trial = 0; trial < trials; ++trial) CHECK(same_bits(before[trial], after[trial]));
    }
}

}  // namespace credence::test::keys_test
