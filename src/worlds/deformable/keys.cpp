#include "worlds/deformable/keys.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include "worlds/values.hpp"

namespace credence {

namespace {

using Keys = std::vector<DeformableKey>;

/// Adds a key that came after the hash of studies was fixed [KeyOf].
void add_later(Keys& keys, DeformableKey key) {
    key.later = true;
    keys.push_back(std::move(key));
}

/// A whole number from 1 on, or `default`, which leaves it out.
template <class Field>
DeformableKey optional_integer_key(const char* name, const char* help, int most, Field field) {
    return {name, help,
            [=](DeformableSettings& s, const std::string& v) {
                field(s).reset();
                if (v != "default") field(s) = static_cast<int>(parse_integer(name, v, 1, most));
            },
            [=](const DeformableSettings& s) { return field(s) ? std::to_string(*field(s)) : "default"; },
            {"default"}};
}

void add_scenario_keys(Keys& keys) {
    add_common_keys(keys);
    keys.push_back(choice_key<Process>("model.process", {"heading", "translation"},
                                       [](auto& s) -> auto& { return s.process; }));
}

void add_feature_keys(Keys& keys) {
    keys.push_back({"features.positions", "f_0 as `x y, x y`, 1 to 64 of them (length)",
                    [](DeformableSettings& s, const std::string& v) {
                        s.features.positions = parse_points("features.positions", v, largest_feature_count);
                    },
                    [](const DeformableSettings& s) { return positions_text(s.features.positions); }});
    add_later(keys, optional_integer_key(
                        "features.count",
                        "M, 1 to 64, where they are placed in a box or ring; default as many as positions",
                        largest_feature_count, [](auto& s) -> auto& { return s.features.count; }));
    add_later(keys, choice_key<Placement>("features.placement", {"given", "box", "ring"},
                                          [](auto& s) -> auto& { return s.features.placement; }));
    add_later(keys, real_key("features.extent", "side of the box about the first position (length)", above(0),
                             [](auto& s) -> auto& { return s.features.extent; }));
    add_later(keys, real_key("features.radius_min", "inner radius of the ring about the first position (length)",
                             from(0), [](auto& s) -> auto& { return s.features.radius_min; }));
    add_later(keys, real_key("features.radius_max", "outer radius of the ring (length)", above(0),
                             [](auto& s) -> auto& { return s.features.radius_max; }));
    keys.push_back(choice_key<Path>("features.path", {"straight", "circle", "static"},
                                    [](auto& s) -> auto& { return s.features.path; }));
    keys.push_back(real_key("features.step", "d, what features and robot move a step (length)", above(0),
                            [](auto& s) -> auto& { return s.features.step; }));
    keys.push_back(real_key("features.turn", "delta, turn per step on the circle (rad)", between(-3.2, 3.2),
                            [](auto& s) -> auto& { return s.features.turn; }));
    keys.push_back(real_key("features.sway_amplitude", "A, radius of the known local deformation (length)", from(0),
                            [](auto& s) -> auto& { return s.features.sway_amplitude; }));
    keys.push_back(real_key("features.sway_period", "T (poses)", from(1e-3),
                            [](auto& s) -> auto& { return s.features.sway_period; }));
}

void add_sensor_keys(Keys& keys) {
    keys.push_back(real_key("sensor.range_min", "nearest range seen, included (length)", from(0),
                            [](auto& s) -> auto& { return s.sensor.range_min; }));
    keys.push_back(real_key("sensor.range_max", "farthest range seen, included (length); inf for no limit",
                            above_or_infinite(0), [](auto& s) -> auto& { return s.sensor.range_max; }));
    keys.push_back(choice_key<RangeNoise>("sensor.noise", {"constant", "ranged"},
                                          [](auto& s) -> auto& { return s.sensor.noise; }));
    keys.push_back(real_key("sensor.sigma", "constant noise of each axis (length)", from(0),
                            [](auto& s) -> auto& { return s.sensor.sigma; }));
    keys.push_back(real_key("sensor.sigma_near", "ranged noise at range_min (length)", from(0),
                            [](auto& s) -> auto& { return s.sensor.sigma_near; }));
    keys.push_back(real_key("sensor.sigma_far", "ranged noise at range_max, not clamped beyond (length)", from(0),
                            [](auto& s) -> auto& { return s.sensor.sigma_far; }));
    keys.push_back(real_key("sensor.detection", "probability that a feature in range is seen", between(0, 1),
                            [](auto& s) -> auto& { return s.sensor.detection; }));
    add_later(keys, integer_key("sensor.every", "steps from one measurement of the features to the next", 1,
                                largest_pose_count, [](auto& s) -> auto& { return s.sensor.every; }));
}

void add_noise_keys(Keys& keys) {
    keys.push_back(real_key("noise.heading", "sigma_head of a step", from(0),
                            [](auto& s) -> auto& { return s.noise.heading; }, "rad"));
    keys.push_back(real_key("noise.odometry", "sigma_odom of a step and axis (length)", from(0),
                            [](auto& s) -> auto& { return s.noise.odometry; }));
    keys.push_back(real_key("noise.walk", "sigma_walk of a feature, step and axis (length)", from(0),
                            [](auto& s) -> auto& { return s.noise.walk; }));
    keys.push_back(real_key("noise.deformation", "sigma_def of a feature and axis; also the edges' (length)", from(0),
                            [](auto& s) -> auto& { return s.noise.deformation; }));
    keys.push_back(real_key("noise.initial_heading", "sigma of the first heading, known to the filter", from(0),
                            [](auto& s) -> auto& { return s.noise.initial_heading; }, "rad"));
    keys.push_back(real_key("noise.initial_position", "sigma of the first position, known to the filter (length)",
                            from(0), [](auto& s) -> auto& { return s.noise.initial_position; }));
    add_later(keys, real_key(
                        "noise.odometry_bias",
                        "sigma of a bias of the odometry, each axis of the body, constant in a trial (length a step)",
                        from(0), [](auto& s) -> auto& { return s.noise.odometry_bias; }));
    add_later(keys, choice_key<Tails>("noise.measurement_tails", {"normal", "student", "contaminated"},
                                      [](auto& s) -> auto& { return s.noise.measurement_tails; }));
    add_later(keys, real_key("noise.degrees_of_freedom", "of Student's t, which keeps the sensor's sigma", above(2),
                             [](auto& s) -> auto& { return s.noise.degrees_of_freedom; }));
    add_later(keys, real_key("noise.outlier_share", "of the measurements, where they are contaminated", between(0, 1),
                             [](auto& s) -> auto& { return s.noise.outlier_share; }));
    add_later(keys, real_key("noise.outlier_scale", "factor on the sensor's sigma of an outlier", from(0),
                             [](auto& s) -> auto& { return s.noise.outlier_scale; }));
    keys.push_back({"noise.truncate", "none, or the multiple of sigma beyond which a draw is redrawn (0.1 to 8)",
                    [](DeformableSettings& s, const std::string& v) { s.noise.truncate = parse_truncate(v); },
                    [](const DeformableSettings& s) { return s.noise.truncate ? to_text(*s.noise.truncate) : "none"; },
                    {"none"}});
}

void add_rule_keys(Keys& keys) {
    keys.push_back(choice_key<Deformation>("truth.deformation", {"jitter", "walk"},
                                           [](auto& s) -> auto& { return s.truth.deformation; }));
    keys.push_back(choice_key<EdgeNoise>("truth.edge_noise", {"none", "independent"},
                                         [](auto& s) -> auto& { return s.truth.edge_noise; }));
    keys.push_back({"edges.graph", "all, chain, none, or a list of pairs `0-1, 1-2`",
                    [](DeformableSettings& s, const std::string& v) { s.edges = parse_graph(v); },
                    [](const DeformableSettings& s) { return graph_text(s.edges); }, {"all", "chain", "none"}});
}

void add_filter_keys(Keys& keys) {
    const auto factor = [&](const char* name, const char* help, auto field) {
        keys.push_back(real_key(name, help, from(0), field));
    };
    factor("filter.heading", "factor on the believed noise.heading", [](auto& s) -> auto& { return s.filter.heading; });
    factor("filter.odometry", "factor on the believed noise.odometry",
           [](auto& s) -> auto& { return s.filter.odometry; });
    factor("filter.features", "factor on the believed walk and deformation",
           [](auto& s) -> auto& { return s.filter.features; });
    factor("filter.measurement", "factor on the believed sensor noise",
           [](auto& s) -> auto& { return s.filter.measurement; });
    factor("filter.edges", "factor on the believed edge noise", [](auto& s) -> auto& { return s.filter.edges; });
    factor("filter.covariance", "factor on the reported P, for testing the judge",
           [](auto& s) -> auto& { return s.filter.covariance; });
    add_later(keys, real_key("filter.gate", "probability of chi-square beyond which a sighting is rejected; 1 for none",
                             ValueRange{0, 1, false, false}, [](auto& s) -> auto& { return s.filter.gate; }));
}

std::vector<Point> parse_waypoints(const std::string& value) {
    if (value == "none") return {};
    return parse_points("control.waypoints", value, largest_waypoint_count);
}

std::vector<std::string> estimators_to_offer() {
    std::vector<std::string> names = estimator_names();
    names.push_back("default");
    return names;
}

void add_control_keys(Keys& keys) {
    keys.push_back(choice_key<FixedPath>(
        "control.path", {"as-features", "straight", "circle"}, [](auto& s) -> auto& { return s.fixed_path; }));
    add_later(keys,
              {"control.waypoints",
               "none, or the path of the controller waypoints as `x y, x y`, from 0 0 on (length)",
               [](DeformableSettings& s, const std::string& v) { s.waypoints = parse_waypoints(v); },
               [](const DeformableSettings& s) { return s.waypoints.empty() ? "none" : positions_text(s.waypoints); },
               {"none"}});
}

void add_planner_keys(Keys& keys) {
    add_later(keys, choice_key<Criterion>(
        "planner.criterion", {"trace", "log_det", "max_eigenvalue", "pose_trace", "pose_log_det", "features_trace"},
        [](auto& s) -> auto& { return s.planner.criterion; }));
    add_later(keys, real_key("planner.heading_weight",
                             "what 1 rad^2 counts in a trace or eigenvalue that is minimised (length^2)", from(0),
                             [](auto& s) -> auto& { return s.planner.heading_weight; }));
    keys.push_back(optional_integer_key(
        "planner.speeds", "half-width of the grid of speeds in steps of d/5 (1 to 100); default the process's own", 100,
        [](auto& s) -> auto& { return s.planner.speeds; }));
    keys.push_back({"planner.turns",
                    "turns of the candidates (rad), up to 100; none in the translation model; default the path's own",
                    [](DeformableSettings& s, const std::string& v) { s.planner.turns = parse_turns(v); },
                    [](const DeformableSettings& s) { return turns_text(s.planner.turns); }, {"default", "none"}});
    keys.push_back(optional_integer_key(
        "planner.horizon",
        "steps that the controller horizon plans ahead (1 to 8; 1 is greedy); default 2, or 1 where no arm has it",
        largest_horizon, [](auto& s) -> auto& { return s.planner.horizon; }));
}

void add_arm_keys(Keys& keys) {
    keys.push_back({"arms.controllers", "any of " + joined(controller_names()),
                    [](DeformableSettings& s, const std::string& v) { s.arms.controllers = parse_controllers(v); },
                    [](const DeformableSettings& s) { return names_text(s.arms.controllers, controller_names()); },
                    controller_names()});
    keys.push_back(
        {"arms.estimators",
         "any of " + joined(estimator_names()) + " (kf: translation, the others: heading); default: ekf or kf",
         [](DeformableSettings& s, const std::string& v) { s.arms.estimators = parse_estimators(v); },
         [](const DeformableSettings& s) {
             return s.arms.estimators ? names_text(*s.arms.estimators, estimator_names()) : "default";
         },
         estimators_to_offer()});
}

void add_published_keys(Keys& keys) {
    const auto published = [&](const char* name, auto field) {
        keys.push_back({name, "published values to show in our distribution, as `arm value, arm value`",
                        [=](DeformableSettings& s, const std::string& v) { field(s) = parse_published(name, v); },
                        [=](const DeformableSettings& s) { return published_text(field(s)); }});
    };
    published("published.trace_P", [](auto& s) -> auto& { return s.published.trace_P; });
    published("published.unseen", [](auto& s) -> auto& { return s.published.unseen; });
    published("published.pose_error", [](auto& s) -> auto& { return s.published.pose_error; });
}

/// Hidden: a scenario has it where it has planners of one's own [docs/planner.md].
void add_own_planner_key(Keys& keys) {
    keys.push_back({"arms.planners", "none, or planners of one's own by their names",
                    [](DeformableSettings& s, const std::string& v) { s.arms.planners = parse_own_planners(v); },
                    [](const DeformableSettings& s) { return own_planners_text(s.arms.planners); }, {"none"}});
    keys.back().hidden = true;
}

Keys all_keys() {
    Keys keys;
    add_scenario_keys(keys);
    add_feature_keys(keys);
    add_sensor_keys(keys);
    add_noise_keys(keys);
    add_rule_keys(keys);
    add_filter_keys(keys);
    add_control_keys(keys);
    add_planner_keys(keys);
    add_arm_keys(keys);
    add_own_planner_key(keys);
    add_published_keys(keys);
    add_budget_keys(keys, slam_sources());
    return keys;
}

}  // namespace

const std::vector<DeformableKey>& scenario_keys() {
    static const Keys keys = all_keys();
    return keys;
}

void set_key(DeformableSettings& scenario, const std::string& name, const std::string& value) {
    set_key(scenario_keys(), scenario, name, value);
}

std::string scenario_text(const DeformableSettings& scenario) {
    Scenario described;
    for (const DeformableKey& key : scenario_keys()) described.settings.push_back({key.name, key.get(scenario)});
    return scenario_text(described);
}

}  // namespace credence
