// Every key of a scenario: its default, what it takes, what it refuses, and the way to text and back.
// Kind: foreign files.

#include "catch.hpp"
#include "support.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/keys.hpp"

#include <algorithm>
#include <set>
#include <sstream>

namespace credence::test::scenario_test {

namespace {

struct KeyCase {
    std::string name, default_text;
    std::vector<std::string> good, bad;  ///< texts that come back as they are; texts that are refused
};

/// The keys of a scenario, with the reference study's defaults.
const std::vector<KeyCase>& key_cases() {
    static const std::vector<std::string> not_a_length{"-1", "-1e-9", "2e9"}, not_positive{"0", "-1", "2e9"};
    static const std::vector<KeyCase> cases{
        {"scenario.name",
         "scenario",
         {"a", "kf-circle_2", std::string(100, 'x')},
         {"", "a b", "a/b", "ä", "..", std::string(101, 'x')}},
        {"scenario.title",
         "",
         {"EKF (heading model), 0.01 rad", "Größe"},
         {"a # b", std::string(301, 'x'), "tab\there"}},
        {"scenario.length_unit", "dm", {"m", "km", "µm"}, {"", "a b", "m^2", std::string(17, 'm')}},
        {"scenario.poses", "20", {"2", "100000"}, {"1", "0", "-5", "100001", "2.5", "9223372036854775808"}},
        {"model.process", "heading", {"translation"}, {"Heading", "ekf"}},
        {"features.positions",
         "0.5 0.5, 0.9 0.8, 0.3 0.4",
         {"1 2", "-1 -2, 3 4"},
         {"1", "1 2, 3", "1 2,", "1 2 3", "2e9 0", "1 inf"}},
        {"features.count", "default", {"1", "64"}, {"0", "65", "-1", "1.5", "all"}},
        {"features.placement", "given", {"box", "ring"}, {"random", "Box"}},
        {"features.extent", "2", {"0.5"}, not_positive},
        {"features.radius_min", "0", {"0.5"}, not_a_length},
        {"features.radius_max", "2", {"0.5"}, not_positive},
        {"features.path", "straight", {"circle", "static"}, {"still", "0"}},
        {"features.step", "2", {"0.001", "1e+09"}, not_positive},
        {"features.turn", "0.3141592653589793", {"-3.2", "0", "3.2"}, {"3.3", "-3.3"}},
        {"features.sway_amplitude", "0", {"0.5"}, not_a_length},
        {"features.sway_period", "20", {"0.5"}, not_positive},
        {"sensor.range_min", "0.1", {"0", "1.5"}, not_a_length},
        {"sensor.range_max", "2", {"3", "inf"}, {"0", "-1", "2e9", "-inf"}},
        {"sensor.noise", "constant", {"ranged"}, {"linear"}},
        {"sensor.sigma", "0.05", {"0", "0.1"}, not_a_length},
        {"sensor.sigma_near", "0.01", {"0", "0.1"}, not_a_length},
        {"sensor.sigma_far", "0.09", {"0", "0.1"}, not_a_length},
        {"sensor.detection", "1", {"0", "0.5"}, {"1.01", "-0.1"}},
        {"sensor.every", "1", {"2", "100000"}, {"0", "-1", "1.5", "100001"}},
        {"noise.heading", "0.001", {"0", "0.1"}, not_a_length},
        {"noise.odometry", "0.02", {"0", "0.1"}, not_a_length},
        {"noise.walk", "0.3", {"0", "0.1"}, not_a_length},
        {"noise.deformation", "0.2", {"0", "0.1"}, not_a_length},
        {"noise.initial_heading", "0", {"0.1"}, not_a_length},
        {"noise.initial_position", "0", {"0.1"}, not_a_length},
        {"noise.odometry_bias", "0", {"0.1"}, not_a_length},
        {"noise.measurement_tails", "normal", {"student", "contaminated"}, {"t", "gauss"}},
        {"noise.degrees_of_freedom", "5", {"2.1", "1000"}, {"2", "0", "-3", "inf"}},
        {"noise.outlier_share", "0.1", {"0", "1"}, {"1.1", "-0.1"}},
        {"noise.outlier_scale", "3", {"0", "10"}, not_a_length},
        {"noise.truncate", "none", {"2", "0.1", "8"}, {"0.09", "8.1", "-2", "never"}},
        {"truth.deformation", "jitter", {"walk"}, {"none"}},
        {"truth.edge_noise", "none", {"independent"}, {"jitter"}},
        {"edges.graph",
         "all",
         {"chain", "none", "0-1", "0-1, 1-2"},
         {"1-0", "1-1", "0-1, 0-1", "0-64", "0", "0-", "-1-2", "0-1,", "0-1.5", "some"}},
        {"filter.heading", "1", {"0", "0.5"}, not_a_length},
        {"filter.odometry", "1", {"0", "0.5"}, not_a_length},
        {"filter.features", "1", {"0", "0.5"}, not_a_length},
        {"filter.measurement", "1", {"0", "0.5"}, not_a_length},
        {"filter.edges", "1", {"0", "0.5"}, not_a_length},
        {"filter.covariance", "1", {"0", "0.5"}, not_a_length},
        {"filter.gate", "1", {"0.99", "0.5"}, {"0", "1.01", "-1"}},
        {"control.path", "as-features", {"straight", "circle"}, {"static", "features"}},
        {"control.waypoints", "none", {"1 2", "-1 -2, 3 4"}, {"1", "1 2, 3", "1 2,", "2e9 0", "some"}},
        {"planner.criterion",
         "trace",
         {"log_det", "max_eigenvalue", "pose_trace", "pose_log_det", "features_trace"},
         {"det", "Trace"}},
        {"planner.heading_weight", "1", {"0", "25"}, not_a_length},
        {"planner.speeds", "default", {"1", "5", "100"}, {"0", "101", "-1", "1.5", "none"}},
        {"planner.turns", "default", {"none", "0", "-0.5, 0, 0.5"}, {"3.3", "0, x", "0,,1", "a"}},
        {"planner.horizon", "default", {"1", "8"}, {"0", "9", "-1", "1.5", "none"}},
        {"arms.controllers",
         "fixed, greedy",
         {"fixed", "greedy", "greedy, fixed", "fixed, greedy, horizon", "random, nearest, follow, waypoints"},
         {"fixed, fixed", "best", "fixed,"}},
        {"arms.estimators", "default", {"ekf", "kf"}, {"ukf", "ekf, ekf"}},
        {"arms.planners", "none", {"mine", "mine:a1, other"}, {"greedy", "a.b", "a, a", "a:"}},
        {"published.trace_P",
         "",
         {"fixed.ekf 0.1061", "fixed.ekf 0.1061, greedy.ekf 0.1034"},
         {"fixed.ekf", "fixed.ekf x", "fixed.ekf 1 2"}},
        {"published.unseen", "", {"fixed.ekf 3"}, {"fixed.ekf", "fixed.ekf inf"}},
        {"published.pose_error", "", {"fixed.ekf 0.1629"}, {"fixed.ekf"}},
        {"draws.other", "none", {"heading", "start, walk, control"}, {"heding", "heading walk", "Walk"}},
        {"draws.errors", "none", {"last", "mean"}, {"first", "last, mean"}},
    };
    return cases;
}

const DeformableKey& key_named(const std::string& name) {
    const auto& keys = scenario_keys();
    return *std::find_if(keys.begin(), keys.end(), [&](const DeformableKey& key) { return key.name == name; });
}

/// Reads back what scenario_text writes: sections, `key = value`, blank lines.
DeformableSettings read_text(const std::string& text) {
    DeformableSettings scenario;
    std::istringstream lines(text);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) continue;
        if (line.front() == '[') {
            section = line.substr(1, line.size() - 2);
            continue;
        }
        const std::size_t equals = line.find(" = ");
        set_key(scenario, section + "." + line.substr(0, equals), line.substr(equals + 3));
    }
    return scenario;
}

/// Checks that a value is refused in the one grammar, naming the key, on one line.
void check_refused(const std::string& name, const std::string& value) {
    CAPTURE(name, value);
    DeformableSettings scenario;
    try {
        set_key(scenario, name, value);
        FAIL("it was taken");
    } catch (const InputError& error) {
        const std::string message = error.what();
        CHECK(message.starts_with("invalid " + name + "="));
        CHECK(message.ends_with("."));
        CHECK(message.find('\n') == std::string::npos);
        CHECK(error.complaint().subject == name);
    }
}

}  // namespace

TEST_CASE("scenario: the keys are those of the list, each with a line of help") {
    std::set<std::string> designed, present;
    for (const KeyCase& one : key_cases()) designed.insert(one.name);
    for (const DeformableKey& key : scenario_keys()) {
        present.insert(key.name);
        CHECK_FALSE(key.help.empty());
        CHECK(key.help.find('\n') == std::string::npos);
    }
    CHECK(present == designed);
    CHECK(present.size() == scenario_keys().size());
}

TEST_CASE("scenario: every key has the reference study's default") {
    for (const KeyCase& one : key_cases()) {
        CAPTURE(one.name);
        CHECK(key_named(one.name).get(DeformableSettings{}) == one.default_text);
    }
}

TEST_CASE("scenario: every key takes its values, shows them again and survives the way through text") {
    for (const KeyCase& one : key_cases()) {
        std::vector<std::string> values = one.good;
        values.push_back(one.default_text);
        for (const std::string& value : values) {
            CAPTURE(one.name, value);
            DeformableSettings scenario;
            set_key(scenario, one.name, value);
            CHECK(key_named(one.name).get(scenario) == value);
            const std::string text = scenario_text(scenario);
            CHECK(scenario_text(read_text(text)) == text);
            // Nothing else has changed: setting the default again gives the text of the default.
            set_key(scenario, one.name, one.default_text);
            CHECK(scenario_text(scenario) == scenario_text(DeformableSettings{}));
        }
    }
}

TEST_CASE("scenario: every key refuses what is out of range, naming itself") {
    for (const KeyCase& one : key_cases())
        for (const std::string& value : one.bad) check_refused(one.name, value);
}

TEST_CASE("scenario: every key that is no text refuses garbage") {
    for (const KeyCase& one : key_cases()) {
        if (one.name == "scenario.name" || one.name == "scenario.title" || one.name == "scenario.length_unit") continue;
        for (const char* value : {"1 x", "1;2", "\"1\"", ";"}) check_refused(one.name, value);
        // Any word is a name of a planner.
        if (one.name != "arms.planners")
            for (const char* value : {"garbage", "nan", "0x10", "1e400"}) check_refused(one.name, value);
        if (!one.name.starts_with("published.")) check_refused(one.name, "");
    }
}

TEST_CASE("scenario: a number may be written in many ways and is kept to the bit") {
    DeformableSettings scenario;
    set_key(scenario, "scenario.poses", "1e3");
    CHECK(scenario.poses == 1000);
    set_key(scenario, "noise.walk", "+3e-1");
    CHECK(scenario.noise.walk == 0.3);
    set_key(scenario, "features.positions", "  1   2 ,3\t4 ");
    CHECK(scenario.features.positions == std::vector<Point>{{1, 2}, {3, 4}});
    for (const double value : {0.1, 1.0 / 3, 2.718281828459045, 1e-300}) {
        scenario.noise.walk = value;
        CHECK(same_bits(read_text(scenario_text(scenario)).noise.walk, value));
    }
}

TEST_CASE("scenario: up to 64 features, 1000 waypoints and 100 turns are taken") {
    const auto repeated = [](const char* one, int count) {
        std::string text = one;
        for (int i = 1; i < count; ++i) text += std::string(", ") + one;
        return text;
    };
    DeformableSettings scenario;
    set_key(scenario, "features.positions", repeated("1 2", 64));
    CHECK(scenario.features.positions.size() == 64);
    check_refused("features.positions", repeated("1 2", 65));
    set_key(scenario, "control.waypoints", repeated("1 2", 1000));
    CHECK(scenario.waypoints.size() == 1000);
    check_refused("control.waypoints", repeated("1 2", 1001));
    set_key(scenario, "planner.turns", repeated("0.1", 100));
    CHECK(scenario.planner.turns->size() == 100);
    check_refused("planner.turns", repeated("0.1", 101));
}

}  // namespace credence::test::scenario_test
