// Sweeps: values and ranges, grids, names of points, and places as text.
// Kind: foreign files.

#include "catch.hpp"

#include <credence/error.hpp>
#include <credence/detail/sweep.hpp>
#include <credence/text.hpp>

#include <algorithm>

namespace credence::test::sweep_test {

using Catch::Contains;

namespace {

using Texts = std::vector<std::string>;

Texts values_of(const std::string& text) { return parse_axis(text).values; }

template <class Call>
std::string refusal(Call call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string refused(const Texts& sweeps) {
    return refusal([&] { parse_grid(sweeps); });
}

Texts names_of(const Texts& sweeps) {
    const std::vector<SweepAxis> axes = parse_grid(sweeps);
    Texts names;
    for (const auto& point : grid_points(axes)) names.push_back(point_name("base", axes, point));
    return names;
}

}  // namespace

TEST_CASE("sweep: values are parted by commas, or by bars where they hold commas") {
    CHECK(parse_axis(" noise.heading = 0.01 , 0.1").key == "noise.heading");
    CHECK(values_of("noise.heading=0.01 , 0.1") == Texts{"0.01", "0.1"});
    CHECK(values_of("sensor.noise=constant,ranged") == Texts{"constant", "ranged"});
    CHECK(values_of("planner.turns=0|-0.3, 0, 0.3") == Texts{"0", "-0.3, 0, 0.3"});
    CHECK(values_of("filter.covariance=1") == Texts{"1"});
}

TEST_CASE("sweep: a bar behind a list makes it one value") {
    CHECK(values_of("planner.turns=-0.3, 0, 0.3|") == Texts{"-0.3, 0, 0.3"});
    CHECK_THROWS_WITH(parse_axis("planner.turns=|"), Contains("a value is empty"));
}

TEST_CASE("sweep: a range has its ends as given and round numbers between them") {
    CHECK(values_of("a.b=0:1:6") == Texts{"0", "0.2", "0.4", "0.6", "0.8", "1"});
    CHECK(values_of("a.b=0.1:0.9:9") == Texts{"0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9"});
    CHECK(values_of("a.b=1:0:3") == Texts{"1", "0.5", "0"});
    CHECK(values_of("a.b=-1:2:4") == Texts{"-1", "0", "1", "2"});  // not -0
    CHECK(values_of("a.b=10:100:4") == Texts{"10", "40", "70", "100"});
    // A step of a third is given to six digits of itself, next to a million as well.
    CHECK(values_of("a.b=1000000:1000001:4") == Texts{"1e+06", "1000000.333333", "1000000.666667", "1000001"});
    CHECK(values_of("a.b=0.001:0.1:3:log") == Texts{"0.001", "0.01", "0.1"});
    CHECK(values_of("a.b=0.001:0.1:5:log") == Texts{"0.001", "0.00316228", "0.01", "0.0316228", "0.1"});
    CHECK(values_of("a.b=0, 1:4:4 , 10") == Texts{"0", "1", "2", "3", "4", "10"});
    CHECK(values_of("a.b=0.333333333:1.77777777777:2") == Texts{"0.333333333", "1.77777777777"});
}

TEST_CASE("sweep: what is no sweep is refused in one line that says why") {
    const std::vector<std::pair<Texts, std::string>> cases{
        {{"noise.heading"}, "there is no = in it"},
        {{"noise.heading="}, "it has no value"},
        {{"noise.heading=0.1,"}, "a value is empty"},
        {{"noise.heading=1:2"}, "'1:2' is not a range"},
        {{"noise.heading=1:2:3:lin"}, "'1:2:3:lin' is not a range"},
        {{"noise.heading=1:x:3"}, "the ends of '1:x:3' are not numbers"},
        {{"sensor.range_max=1:inf:3"}, "the ends of '1:inf:3' are not numbers"},
        {{"noise.heading=1:2:1"}, "'1:2:1' needs 2 to 1000 points"},
        {{"noise.heading=1:2:1e9"}, "'1:2:1e9' needs 2 to 1000 points"},
        {{"noise.heading=1:1:3"}, "the ends of '1:1:3' are the same"},
        {{"noise.heading=0:2:3:log"}, "a range with log has ends above 0"},
        {{"noise.heading=-1:-2:3:log"}, "a range with log has ends above 0"},
        {{"noise.heading=0.1,1e-1"}, "0.1 is given twice"},
        {{"noise.heading=0.1", "noise.heading=0.2"},
         "invalid --sweep=noise.heading=0.2 (noise.heading is swept twice)"},
        {{"scenario.name=a,b"}, "scenario.name changes nothing"},
        {{"scenario.title=a,b"}, "scenario.title changes nothing"},
        {{"scenario.length_unit=m,dm"}, "scenario.length_unit changes nothing"},
        {{"published.unseen=fixed.ekf 1"}, "published.unseen changes nothing"},
        {{"sweep.of=a"}, "sweep.of changes nothing"},
        {{"noise.heading=0.1:1:40", "noise.walk=0.1:1:26"}, "the grid has more than 1000 points"}};
    for (const auto& [sweeps, why] : cases) {
        CAPTURE(joined(sweeps));
        CHECK_THAT(refused(sweeps), Contains(why));
        CHECK(refused(sweeps).find('\n') == std::string::npos);
    }
    CHECK(refused({"noise.heading=0.1:1:40", "noise.walk=0.1:1:25"}).empty());  // 1000 points
}

TEST_CASE("sweep: a grid has every combination once, the first key slowest") {
    const auto points =
        grid_points(parse_grid({"noise.heading=0.1,0.2", "sensor.noise=constant,ranged", "noise.walk=1"}));
    Texts texts;
    for (const auto& point : points) texts.push_back(coordinates_text(point));
    CHECK(texts == Texts{"noise.heading=0.1, sensor.noise=constant, noise.walk=1",
                         "noise.heading=0.1, sensor.noise=ranged, noise.walk=1",
                         "noise.heading=0.2, sensor.noise=constant, noise.walk=1",
                         "noise.heading=0.2, sensor.noise=ranged, noise.walk=1"});
    CHECK(point_count(parse_grid({"a.b=1:9:9", "c.d=1:5:5"})) == 45);
    CHECK(point_count({}) == 1);
    CHECK(grid_points({}) == std::vector<std::vector<SweepCoordinate>>{{}});
}

TEST_CASE("sweep: points have names that can be read and that scenarios may have") {
    CHECK(names_of({"noise.heading=1e-2,1e-7"}) == Texts{"base_heading-0p01", "base_heading-1e-07"});
    CHECK(names_of({"features.turn=-0.5,0.5"}) == Texts{"base_turn-m0p5", "base_turn-0p5"});
    CHECK(names_of({"sensor.sigma=0.1", "control.path=as-features,circle"}) ==
          Texts{"base_sigma-0p1_path-as-features", "base_sigma-0p1_path-circle"});
    CHECK(names_of({"noise.heading=0.1", "filter.heading=1"}) == Texts{"base_noise-heading-0p1_filter-heading-1"});
    CHECK(names_of({"planner.turns=0|0, 0.3"}) == Texts{"base_turns-0", "base_turns-0_0p3"});
    CHECK(names_of({"arms.estimators=ekf,riekf|iekf"}) == Texts{"base_estimators-ekf_riekf", "base_estimators-iekf"});
    // Where a name would be long, or two the same, the values are numbered.
    CHECK(names_of({"features.positions=1 2|1 2, 3 4, 5 6, 7 8, 9 10, 11 12"}) ==
          Texts{"base_positions-v0", "base_positions-v1"});
    CHECK(point_name("base", {{"a.b", {"x y", "x, y"}}}, {{"a.b", "x, y"}}) == "base_b-v1");
    for (const std::string& name : names_of({"noise.heading=-0.001:1e-9:9", "edges.graph=0-1, 1-2|none|ä, ö"}))
        CHECK(std::all_of(name.begin(), name.end(), is_name_character));
}

TEST_CASE("sweep: a place survives the way through text, its numbers written as everywhere") {
    const std::vector<SweepCoordinate> at{
        {"noise.heading", "0.01"}, {"planner.turns", "-0.5, 0"}, {"sensor.noise", "constant"}};
    CHECK(coordinates_text(at) == "noise.heading=0.01, planner.turns=-0.5, 0, sensor.noise=constant");
    CHECK(parse_coordinates(coordinates_text(at)) == at);
    CHECK(parse_coordinates(" noise.heading = 1e-2,planner.turns=-.5 ,0, sensor.noise=constant") == at);
    CHECK(parse_coordinates("features.positions=1  2.0,3 4").front().value == "1 2, 3 4");
    CHECK(parse_coordinates("").empty());
    const std::vector<std::pair<std::string, std::string>> cases{
        {"noise.heading", "'noise.heading' names no key"}, {"1, noise.heading=1", "'1' names no key"},
        {"noise.heading=", "noise.heading has no value"}, {"a.b=1, a.b=2", "a.b is given twice"},
        {"scenario.name=a", "no grid can be over scenario.name"}};
    for (const auto& one : cases)
        CHECK_THAT(refusal([&] { parse_coordinates(one.first); }),
                   Contains("invalid sweep.at=") && Contains(one.second));
}

}  // namespace credence::test::sweep_test
