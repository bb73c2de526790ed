// What a refused scenario is told to do makes it a scenario that is accepted.

#include "catch.hpp"
#include "support.hpp"

#include <credence/detail/worlds.hpp>
#include <credence/ini.hpp>

namespace credence::test::remedies_test {

namespace {

/// A refused scenario, one of the things that its refusal says to do, and what of that stands in the message.
struct Refused {
    Overrides settings, remedy;
    std::string told;
};

const Overrides no_heading{{"model.process", "translation"}}, ranged{{"sensor.noise", "ranged"}},
    one_feature{{"features.positions", "1 1"}}, two_features{{"features.positions", "1 1, 2 2"}},
    explored{{"scenario.world", "explore"}};

std::string read(const Overrides& settings) {
    return test::refusal([&] { read_scenario_text("", "test", "mine", settings); });
}

/// The settings of both; of a key in both, that of the second.
Overrides operator+(Overrides first, const Overrides& second) {
    for (const auto& setting : second) {
        std::erase_if(first, [&](const auto& one) { return one.first == setting.first; });
        first.push_back(setting);
    }
    return first;
}

std::string text_of(const Overrides& settings) {
    std::string text;
    for (const auto& [key, value] : settings) text += key + "=" + value + "; ";
    return text;
}

}  // namespace

TEST_CASE("scenario: what a refusal says to do leads to a scenario that is accepted") {
    const std::vector<Refused> all{
        {{{"sensor.range_min", "3"}}, {{"sensor.range_max", "inf"}}, "Give a range that is not empty."},
        {{{"sensor.sigma", "0"}}, {{"sensor.sigma", "1.1e-100"}}, "Give a standard deviation above 1e-100."},
        {{{"sensor.sigma", "1e-120"}}, {{"sensor.sigma", "1.1e-100"}}, "Give a standard deviation above 1e-100."},
        {ranged + Overrides{{"sensor.range_max", "inf"}}, {{"sensor.range_max", "5"}}, "Give a finite range or "},
        {ranged + Overrides{{"sensor.range_max", "inf"}}, {{"sensor.noise", "constant"}}, "or sensor.noise=constant."},
        {ranged + Overrides{{"sensor.sigma_near", "0"}},
         {{"sensor.sigma_near", "1.1e-100"}},
         "deviation above 1e-100."},
        {ranged + Overrides{{"sensor.sigma_near", "1"}, {"sensor.sigma_far", "0.5"}},
         {{"sensor.sigma_far", "1"}},
         "Give at least sigma_near."},
        {{{"noise.heading", "1e-120"}}, {{"noise.heading", "1.1e-100"}}, "deviation above 1e-100, or"},
        {{{"noise.heading", "0"}},
         {{"noise.initial_heading", "1.1e-100"}},
         "or set noise.initial_heading above 1e-100."},
        {{{"noise.heading", "0"}, {"noise.initial_heading", "1e-120"}},
         {{"noise.initial_heading", "1.1e-100"}},
         "or set noise.initial_heading above 1e-100."},
        {{{"filter.heading", "0"}}, {{"filter.heading", "1"}}, "Give a larger factor, or "},
        {{{"filter.heading", "0"}},
         {{"noise.initial_heading", "1.1e-100"}},
         "or set noise.initial_heading above 1e-100."},
        {{{"noise.odometry", "0"}},
         {{"noise.initial_position", "1.1e-100"}},
         "or set noise.initial_position above 1e-100."},
        {{{"noise.deformation", "0"}},
         {{"noise.deformation", "1.1e-100"}},
         "Give a standard deviation above 1e-100, or "},
        {{{"noise.deformation", "0"}}, {{"edges.graph", "none"}}, "or set edges.graph=none."},
        {{{"filter.edges", "0"}}, {{"edges.graph", "none"}}, "or set edges.graph=none."},
        {{{"filter.measurement", "1e-120"}}, {{"filter.measurement", "1.1e-100"}}, "Give a factor above 1e-100."},
        {{{"filter.covariance", "0"}}, {{"filter.covariance", "1.1e-100"}}, "Give a factor above 1e-100."},
        {no_heading + Overrides{{"noise.initial_heading", "0.1"}}, {{"noise.initial_heading", "0"}}, "Set it to 0 or "},
        {no_heading + Overrides{{"noise.initial_heading", "0.1"}},
         {{"model.process", "heading"}},
         "or use model.process=heading."},
        {one_feature + Overrides{{"edges.graph", "0-1"}}, {{"edges.graph", "none"}}, "Set it to none."},
        {two_features + Overrides{{"edges.graph", "0-2"}}, {{"edges.graph", "0-1"}}, "Name features 0 to 1."},
        {{{"edges.graph", "0-70"}}, {{"edges.graph", "0-2"}}, "Features count from 0 to 63."},
        {{{"edges.graph", "1-0"}}, {{"edges.graph", "0-1"}}, "Write pairs as `0-1`."},
        {{{"edges.graph", "0-1, 0-1"}}, {{"edges.graph", "0-1"}}, "Name each edge once."},
        {{{"edges.graph", ""}}, {{"edges.graph", "none"}}, "Write none for no edges."},
        {{{"features.count", "4"}}, {{"features.placement", "ring"}}, "or set features.placement=box or ring."},
        {{{"features.count", "4"}}, {{"features.count", "default"}}, "Leave it out, or "},
        {{{"features.placement", "ring"}, {"features.radius_min", "3"}},
         {{"features.radius_max", "3"}},
         "Give at least that."},
        {{{"features.positions", "4 0 4 4"}},
         {{"features.positions", "4 0, 4 4"}},
         "Write pairs `x y` separated by commas, such as `4 0, 4 4`."},
        {{{"planner.turns", "none"}}, {{"planner.turns", "0.1"}}, "Give turns in radians."},
        {no_heading + Overrides{{"planner.turns", "0"}}, {{"planner.turns", "none"}}, "Set it to none."},
        {{{"planner.horizon", "2"}}, {{"arms.controllers", "horizon"}}, "Add horizon to arms.controllers, or "},
        {{{"planner.horizon", "2"}}, {{"planner.horizon", "default"}}, "or leave planner.horizon out."},
        {{{"arms.controllers", "horizon"}, {"features.path", "circle"}, {"planner.horizon", "4"}},
         {{"planner.horizon", "1"}},
         "Give fewer steps, "},
        {{{"arms.controllers", "waypoints"}}, {{"control.waypoints", "1 1"}}, "Give control.waypoints."},
        {{{"control.waypoints", "1 1"}}, {{"arms.controllers", "waypoints"}}, "Add waypoints to arms.controllers, or "},
        {{{"control.waypoints", "1 1"}}, {{"control.waypoints", "none"}}, "or leave control.waypoints out."},
        {{{"arms.estimators", "kf"}}, {{"arms.estimators", "ekf"}}, "Give some of ekf, "},
        {{{"arms.estimators", "kf"}}, no_heading, ", or set model.process=translation."},
        {no_heading + Overrides{{"arms.estimators", "iekf"}},
         {{"model.process", "heading"}},
         ", or set model.process=heading."},
        {{{"arms.estimators", "ekf, kf"}},
         {{"arms.estimators", "ekf, iekf"}},
         "Give some of ekf, ideal, fej, riekf, iekf."},
        {{{"arms.controllers", "greedy, greedy"}}, {{"arms.controllers", "greedy"}}, "Name each once."},
        {{{"published.unseen", "greedy.ekv 3"}}, {{"published.unseen", "greedy.ekf 3"}}, "Did you mean greedy.ekf? "},
        {{{"scenario.name", "run"}}, {{"scenario.name", "mine"}}, "Give another text."},
        {{{"scenario.world", "explor"}}, explored, "Did you mean explore? "},
        {explored + Overrides{{"landmarks.prior", "1e-120"}},
         {{"landmarks.prior", "1.1e-100"}},
         "deviation above 1e-100."},
        {explored + Overrides{{"control.waypoints", "none"}}, {{"control.path", "circle"}}, "or another control.path."},
        {explored + Overrides{{"arms.estimators", "kf"}},
         {{"arms.estimators", "iekf"}},
         "Give some of ekf, ideal, fej, riekf, iekf."},
    };
    for (const Refused& one : all) {
        CAPTURE(text_of(one.settings), text_of(one.remedy));
        const std::string message = read(one.settings);
        CHECK_THAT(message, Catch::Contains(one.told));
        CHECK(read(one.settings + one.remedy) == "");
    }
}

TEST_CASE("scenario: the nearest word is named where a value is not one of a key's words") {
    const auto told = [](const std::string& key, const std::string& value, const std::string& meant) {
        CAPTURE(key, value);
        CHECK_THAT(read({{key, value}}), Catch::Contains("). Did you mean " + meant + "? "));
    };
    told("arms.controllers", "fixed, gready", "greedy");
    told("arms.estimators", "efk", "ekf");
    told("edges.graph", "chian", "chain");
    told("features.path", "cirle", "circle");
    told("features.count", "defalt", "default");
    told("planner.turns", "nne", "none");
    told("planner.speeds", "defualt", "default");
    told("noise.truncate", "nonne", "none");
    told("arms.estimators", "EKF", "ekf");
    CHECK_THAT(read({{"features.path", "polygon"}}), Catch::EndsWith("Give one of straight, circle, static."));
}

TEST_CASE("scenario: another filter's name leads to the page on filters of one's own") {
    const std::string own = "docs/own-filter.md says how to run a filter of your own. ";
    CHECK_THAT(read({{"arms.estimators", "ukf"}}), Catch::Contains("of its choices). " + own + "Give one of ekf"));
    CHECK_THAT(read({{"arms.estimators", "ekf, pf"}}), Catch::Contains("). " + own));
    CHECK_THAT(read({{"arms.estimators", "efk"}}), Catch::Contains("Did you mean ekf? " + own));
}

TEST_CASE("scenario: other words of the field lead to the noise that they name, not to what the filter believes") {
    const auto meant = [](const std::string& key, const Overrides& world = {}) {
        const std::string said = read(world + Overrides{{key, "1"}}), begin = "Did you mean ";
        const std::size_t at = said.find(begin);
        return at == std::string::npos ? "" : said.substr(at + begin.size(), said.size() - at - begin.size() - 1);
    };
    for (const char* key : {"noise.measurement", "noise.sensor", "measurement.noise", "sensor.std", "noise.R", "R",
                            "sensor.noise_sigma", "observation.covariance"})
        CHECK((key + (" " + meant(key))) == key + std::string(" sensor.sigma"));
    for (const char* key : {"noise.process", "process.noise", "noise.motion", "Q"})
        CHECK((key + (" " + meant(key))) == key + std::string(" noise.heading or noise.odometry or noise.walk"));
    CHECK(meant("noise.process", explored) == "noise.heading or noise.odometry");
    CHECK(meant("noise.initial") == "noise.initial_heading or noise.initial_position");
    CHECK(meant("filter.measurment") == "filter.measurement");
    CHECK(meant("fliter.measurement") == "filter.measurement");
    for (const DescribedKey& key : world_of({}).keys())
        if (key.key.starts_with("filter."))
            for (const std::string section : {"noise", "truth", "sensor", "model", "features"})
                CHECK_THAT(read({{section + key.key.substr(key.key.find('.')), "1"}}), !Catch::Contains("filter."));
}

TEST_CASE("scenario: commas in a number and blanks in a list are told what to write") {
    CHECK(read({{"noise.heading", "0,1"}}) ==
          "--set noise.heading: invalid noise.heading=0,1 (it has a comma, and one number is wanted). Write decimals "
          "with a point, several values as --sweep noise.heading=0,1.");
    CHECK_THAT(read({{"scenario.poses", "1,000"}}), Catch::Contains("several values as --sweep scenario.poses=1,000."));
    CHECK(read({{"arms.controllers", "fixed greedy"}}) ==
          "--set arms.controllers: invalid arms.controllers=fixed greedy (blanks part what commas should). Write "
          "fixed, greedy.");
    CHECK_THAT(read({{"arms.estimators", "ekf iekf"}}), Catch::EndsWith("commas should). Write ekf, iekf."));
    CHECK_THAT(read({{"planner.turns", "-0.1 0 0.1"}}), Catch::EndsWith("Write -0.1, 0, 0.1."));
    CHECK_THAT(read({{"edges.graph", "0-1 1-2"}}), Catch::EndsWith("pairs such as `0-1, 1-2`."));
}

TEST_CASE("scenario: a key that stands in its section with its section is told how to be written there") {
    const auto told = [](const std::string& text) {
        return test::refusal([&] { read_scenario_text(text, "x.ini", "mine"); });
    };
    CHECK(told("[features]\nfeatures.path = static\n") ==
          "x.ini:2: unknown key features.features.path. Under [features] write path.");
    CHECK(told("[features]\nnoise.heading = 0.1\n") ==
          "x.ini:2: unknown key features.noise.heading. Under [noise] write heading.");
}

TEST_CASE("scenario: points that are not pairs are told their form") {
    CHECK(read({{"arms.controllers", "waypoints"}, {"control.waypoints", "4 0 4 4"}}) ==
          "--set control.waypoints: invalid control.waypoints=4 0 4 4 ('4 0 4 4' is not a point). Write pairs `x y` "
          "separated by commas, such as `4 0, 4 4`.");
    CHECK_THAT(read({{"features.positions", "1 1, 2"}}), Catch::Contains("('2' is not a point). Write pairs `x y`"));
    CHECK_THAT(read({{"features.positions", "1 1, 2 2e9"}}),
               Catch::Contains("=2e9 (must be at least -1e+09 and at most 1e+09)"));
}

}  // namespace credence::test::remedies_test
