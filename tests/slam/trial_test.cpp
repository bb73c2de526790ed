// One trial: which draws it uses, and the meaning of its columns and series [docs/model.md, Reported per trial].

#include "catch.hpp"
#include "support.hpp"

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace credence::test::trial_test {

namespace {

using Key = std::tuple<Source, int, int>;
using Asked = std::map<Key, std::pair<double, double>>;

/// Noise that writes down every draw that is asked for; a uniform stands there with NaN beside it.
AnyNoise listened(const AnyNoise& noise, Asked& asked) {
    return {[&asked, noise](Source source, int pose, int index) {
                const Vector2<double> draw = noise.normal(source, pose, index);
                asked[{source, pose, index}] = {draw.x, draw.y};
                return draw;
            },
            [&asked, noise](Source source, int pose, int index) {
                const double draw = noise.uniform(source, pose, index);
                asked[{source, pose, index}] = {draw, -1};
                return draw;
            }};
}

Asked asked_by(const DeformableSettings& scenario, Controller controller, std::uint64_t trial) {
    Asked asked;
    run_arm(scenario, controller, listened(keyed_noise(scenario, 50, trial), asked));
    return asked;
}

/// Every key that a trial of the scenario must ask for, whatever is seen.
std::set<Key> expected_keys(const DeformableSettings& scenario) {
    const int features = static_cast<int>(scenario.features.positions.size());
    const int edges = static_cast<int>(edge_list(scenario).size());
    std::set<Key> keys;
    for (int k = 0; k < scenario.poses; ++k) {
        keys.insert({Source::odometry_position, k, 0});
        if (scenario.process == Process::heading) keys.insert({Source::odometry_heading, k, 0});
        for (int j = 0; j < features; ++j) {
            keys.insert({Source::measurement, k, j});
            if (k + 1 < scenario.poses) keys.insert({Source::walk, k, j});
            keys.insert({Source::deformation, k, j});  // at pose 0 too, where a walk has no use for it
            if (scenario.sensor.detection < 1 && k > 0) keys.insert({Source::detection, k, j});
        }
        for (int e = 0; e < edges && k > 0 && scenario.truth.edge_noise == EdgeNoise::independent; ++e)
            keys.insert({Source::edge, k, e});
    }
    return keys;
}

std::vector<Settings> worlds() {
    return {{{"features.path", "circle"}},
            {{"features.path", "circle"}, {"model.process", "translation"}},
            {{"sensor.detection", "0.5"}, {"sensor.range_max", "1"}},
            {{"truth.deformation", "walk"}, {"truth.edge_noise", "independent"}},
            {{"edges.graph", "none"}, {"noise.truncate", "1"}, {"features.path", "circle"}}};
}

/// e' (f P)^-1 e of a component group at a pose.
double squared_error(const RunStep& step, int first, int count, double factor) {
    const Eigen::VectorXd e = (step.mean - step.truth).segment(first, count);
    return e.dot((factor * step.covariance.block(first, first, count, count)).ldlt().solve(e));
}

}  // namespace

TEST_CASE("trial: every draw is asked for, of features out of sight too, and none beside") {
    for (const Settings& settings : worlds())
        for (const Controller controller : {Controller::fixed, Controller::greedy}) {
            CAPTURE(described(settings), static_cast<int>(controller));
            const DeformableSettings scenario = scenario_with(settings);
            std::set<Key> keys;
            for (const auto& [key, draw] : asked_by(scenario, controller, 1)) keys.insert(key);
            CHECK(keys == expected_keys(scenario));
        }
}

TEST_CASE("trial: the two arms of a trial are given the same draws, though they see different features") {
    for (const Settings& settings : worlds()) {
        CAPTURE(described(settings));
        const DeformableSettings scenario = scenario_with(settings);
        bool different_sight = false;
        for (std::uint64_t trial = 0; trial < 5; ++trial) {
            CHECK(asked_by(scenario, Controller::fixed, trial) == asked_by(scenario, Controller::greedy, trial));
            const Run fixed = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 50, trial));
            const Run greedy = run_arm(scenario, Controller::greedy, keyed_noise(scenario, 50, trial));
            for (std::size_t k = 1; k < fixed.steps.size(); ++k) {
                different_sight = different_sight || fixed.steps[k].seen != greedy.steps[k].seen;
                // The features' truth is the same for both arms.
                const Eigen::Index pose = pose_size(scenario), n = fixed.steps[k].truth.size();
                CHECK(same_bits(Eigen::MatrixXd(fixed.steps[k].truth.tail(n - pose)),
                                Eigen::MatrixXd(greedy.steps[k].truth.tail(n - pose))));
            }
        }
        CHECK(different_sight);  // or the test would say nothing
    }
}

TEST_CASE("trial: columns are what the page of the model says, from the steps") {
    for (const Settings& settings : worlds()) {
        Settings drawn = settings;
        drawn.emplace_back("noise.initial_position", "0.3");  // so that pose 0 has an error
        const DeformableSettings scenario = scenario_with(drawn);
        const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 51, 2));
        double pose_error = 0, unseen = 0, nees = 0, nis = 0, rows = 0;
        for (std::size_t k = 0; k < run.steps.size(); ++k) {
            const RunStep& step = run.steps[k];
            pose_error += (step.mean - step.truth).head(pose_size(scenario)).squaredNorm();
            if (k == 0) continue;
            for (const bool seen : step.seen) unseen += !seen;
            nees += squared_error(step, 0, state_size(scenario), 1) / state_size(scenario);
            nis += run.figure("nis", static_cast<int>(k));
            rows += run.figure("nis_rows", static_cast<int>(k));
        }
        // Sums of 20 numbers; NEES by another factorisation, cond(P) below 1e3.
        CHECK(run.columns[column_pose_error] == Approx(pose_error).epsilon(1e-13));
        CHECK(run.columns[column_unseen] == unseen);
        CHECK(run.columns[column_nees_ratio] == Approx(nees / 19).epsilon(1e-12));
        CHECK(run.columns[column_nis_ratio] == Approx(nis / rows).epsilon(1e-13));
        CHECK(run.columns[column_trace_P] == Approx(run.steps.back().covariance.trace()).epsilon(1e-14));
        CHECK(run.columns[column_status] == 0);
        CHECK(run.columns[column_status_pose] == -1);
    }
}

TEST_CASE("trial: pose 0 counts in the pose error and in nothing else") {
    // Features 100 away are not seen at any pose; the robot starts 0.3 off, and its belief with it.
    const DeformableSettings scenario = scenario_with({{"features.positions", "100 0, 0 100"},
                                                       {"noise.initial_position", "0.3"},
                                                       {"edges.graph", "none"},
                                                       {"scenario.poses", "2"}});
    const AnyNoise noise = with_draw(silent_noise(), Source::odometry_position, 0, 0, {1, 2});
    const Run run = run_arm(scenario, Controller::fixed, noise);
    CHECK(run.columns[column_unseen] == 2);
    CHECK(run.columns[column_pose_error] == Approx(2 * 0.09 * 5).epsilon(1e-14));
    CHECK(run.figures.cols() == 1);
    CHECK(run.figure("squared_error_pose", 1) == Approx(0.09 * 5).epsilon(1e-14));
    CHECK(std::isnan(run.columns[column_nis_ratio]));  // there never was a row
}

TEST_CASE("trial: series of a step are what their names say") {
    for (const char* process : {"heading", "translation"}) {
        const DeformableSettings scenario = scenario_with({{"model.process", process}, {"features.path", "circle"},
                                                 {"filter.covariance", "2.25"}, {"noise.heading", "0.01"}});
        const Run run = run_arm(scenario, Controller::fixed, keyed_noise(scenario, 52, 3));
        for (int k = 1; k < scenario.poses; ++k) {
            const RunStep& step = run.steps[static_cast<std::size_t>(k)];
            // Tolerances: a few roundings, and for the squared errors another factorisation, cond(P) below 1e4.
            for (const ComponentGroup& block : state_groups(scenario)) {
                const std::string name = block.name == "all" ? "nees" : "nees_" + block.name;
                CHECK(run.figure(name, k) ==
                      Approx(squared_error(step, block.first, block.count, 2.25)).epsilon(1e-11));
            }
            int seen = 0;
            for (const bool one : step.seen) seen += one;
            CHECK(run.figure("nis_rows", k) == 2 * seen + 6);
            CHECK(run.figure("unseen_features", k) == 3 - seen);
            CHECK(run.figure("trace_P_step", k) == Approx(2.25 * step.covariance.trace()).epsilon(1e-14));
            const std::vector<Component> components = state_components(scenario);
            for (std::size_t i = 0; i < components.size(); ++i) {
                const Eigen::Index at = static_cast<Eigen::Index>(i);
                const double error = (step.mean - step.truth)[at] / std::sqrt(2.25 * step.covariance(at, at));
                CHECK(run.figure("standardised_error_" + components[i].name, k) == Approx(error).epsilon(1e-14));
            }
        }
    }
}

TEST_CASE("trial: a heading error is evaluated the short way round") {
    // The robot turns by 3.1 a step: after two steps truth and belief have passed pi, with different windings.
    const DeformableSettings scenario = scenario_with(
        {{"features.path", "circle"}, {"features.turn", "3.1"}, {"noise.heading", "1"}, {"sensor.range_max", "0.11"}});
    const AnyNoise noise = with_draw(silent_noise(), Source::odometry_heading, 1, 0, {2 * M_PI + 0.5, 0});
    const Run run = run_arm(scenario, Controller::fixed, noise);
    CHECK(run.steps[1].mean[0] - run.steps[1].truth[0] < -6);
    // The difference of two headings near 9 has lost a digit.
    CHECK(run.figure("standardised_error_theta", 1) ==
          Approx(-0.5 / std::sqrt(run.steps[1].covariance(0, 0))).epsilon(1e-12));
    CHECK(run.figure("nees_heading", 1) == Approx(0.25 / run.steps[1].covariance(0, 0)).epsilon(1e-12));
}

}  // namespace credence::test::trial_test
