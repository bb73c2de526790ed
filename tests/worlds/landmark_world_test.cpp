// The world of landmarks as the engine and the program know it: its settings, its scenario, and its trials on every
// target.

#include <credence/detail/block.hpp>
#include <credence/error.hpp>
#include <credence/ini.hpp>
#include "worlds/deformable/deformable.hpp"
#include "worlds/landmarks/trial.hpp"
#include "worlds/landmarks/landmarks.hpp"

#include "catch.hpp"
#include "support.hpp"

namespace credence::test::landmark_world_test {

using Catch::Contains;

namespace {

Scenario landmarks(const std::string& lines) {
    return read_scenario_text("[scenario]\nworld = landmarks\n" + lines, "test", "test");
}

std::string refusal_of(const std::string& lines) {
    return refusal([&] { landmarks(lines); });
}

/// Watches nothing.
struct Unobserved {
    void started(const auto&...) {}
    void predicted(const auto&...) {}
    void updated(const auto&...) {}
};

}  // namespace

TEST_CASE("landmark world: a scenario names its world, and its text reads back as the same") {
    const std::string lines = "poses = 40\nlength_unit = km\n[loop]\nsides = 17\nstep = 2.5\n[landmarks]\ncount = 9\n"
                              "offset = 2\nprior = 3\n[sensor]\nrange_max = inf\nsigma = 0.2\n[noise]\nheading = 0.02\n"
                              "odometry = 0.3\n[arms]\nestimators = riekf, ekf\n";
    const Scenario declared = landmarks(lines);
    CHECK(declared.world == "landmarks");
    CHECK(declared.poses == 40);
    CHECK(declared.length_unit == "km");
    CHECK(declared.arms == std::vector<std::string>{"fixed.riekf", "fixed.ekf"});
    CHECK(declared.components.size() == 3 + 2 * 9);
    CHECK(declared.groups.size() == 5 + 9);
    const Scenario again = read_scenario_text(scenario_text(declared), "test", "other");
    CHECK(again.settings == declared.settings);
    CHECK(again.arms == declared.arms);
    const LandmarkSettings scenario = landmark_settings_of(declared);
    CHECK(scenario.loop.sides == 17);
    CHECK(scenario.loop.step == 2.5);
    CHECK(scenario.landmarks.count == 9);
    CHECK(scenario.landmarks.offset == 2);
    CHECK(scenario.landmarks.prior == 3);
    CHECK(scenario.sensor.range_max == infinity);
    CHECK(scenario.sensor.sigma == 0.2);
    CHECK(scenario.noise.heading == 0.02);
    CHECK(scenario.noise.odometry == 0.3);
}

TEST_CASE("landmark world: settings of another world are not taken for its own") {
    CHECK_THROWS_AS(landmark_settings_of(read_scenario_text("", "test", "mine")), InputError);
    CHECK_THROWS_AS(settings_of(landmarks("poses = 40\n")), InputError);
}

TEST_CASE("landmark world: its keys have help, and their defaults are those of the classical loop") {
    const std::vector<DescribedKey> keys = find_world("landmarks")->keys();
    for (const DescribedKey& key : keys) CHECK(!key.help.empty());
    const Scenario defaults = landmarks("");
    for (const Setting& setting : defaults.settings) {
        if (setting.key == world_key || setting.key == "scenario.name") continue;
        CAPTURE(setting.key);
        const auto found =
            std::find_if(keys.begin(), keys.end(), [&](const DescribedKey& key) { return key.key == setting.key; });
        REQUIRE(found != keys.end());
        CHECK(found->value == setting.value);
    }
    CHECK(defaults.poses == 601);
    CHECK(defaults.arms.size() == 5);
}

TEST_CASE("landmark world: nonsense is refused with its line") {
    CHECK_THAT(refusal_of("[features]\npath = circle\n"), Contains("test:4: unknown key features.path"));
    CHECK_THAT(refusal_of("[loop]\nsides = 2\n"), Contains("test:4: invalid loop.sides=2 (must be at least 3"));
    CHECK_THAT(refusal_of("[loop]\nstep = 0\n"), Contains("must be above 0"));
    CHECK_THAT(refusal_of("[landmarks]\ncount = 65\n"), Contains("at most 64"));
    CHECK_THAT(refusal_of("[landmarks]\noffset = 9.6\n"),
               Contains("test:4: invalid landmarks.offset=9.6 (must be below"));
    CHECK(refusal_of("[landmarks]\noffset = 9.5\n").empty());
    CHECK_THAT(refusal_of("[sensor]\nsigma = 1e-150\n"), Contains("singular"));
    CHECK_THAT(refusal_of("[noise]\nheading = 0\n"), Contains("must be above 0"));
    CHECK_THAT(refusal_of("[arms]\nestimators = ekf, kf\n"), Contains("kf has no heading"));
}

TEST_CASE("landmark world: a block is its trials one by one, on every target") {
    LandmarkSettings scenario;
    scenario.poses = 25;
    scenario.loop.sides = 20;
    scenario.landmarks.count = 6;
    const std::vector<Column> columns = find_world("landmarks")->columns(scenario_of(scenario));
    const LandmarkProblem problem(scenario);
    const LandmarkView& view = problem.view();
    using Heading = Layout<Process::heading, any_count>;
    Unobserved nothing;
    const auto work = std::make_unique<CommonWorkspace<Heading, double>>();
    constexpr int trials = 11;
    for (const Target& target : runnable_targets()) {
        CAPTURE(target.name);
        const Block block =
            run_block(LandmarkSimulation(scenario, target), columns, scenario.estimators.size(), 5, 1, trials);
        const ArmBlock& ekf = block.arms.front();
        for (int trial = 0; trial < trials; ++trial) {
            double own[column_count];
            std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
            run_trial(view, KeyedDraws<double>(5, static_cast<std::uint64_t>(block_size + trial), infinity), nothing,
                      *work, own, figures.data());
            for (std::size_t c = 0; c < column_count; ++c)
                CHECK(same_bits(own[c], ekf.columns[c * trials + static_cast<std::size_t>(trial)]));
            CHECK(own[column_path_length] == Approx((scenario.poses - 1) * scenario.loop.step).epsilon(1e-12));
        }
    }
}

}  // namespace credence::test::landmark_world_test
