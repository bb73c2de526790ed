// Scenario files.
// Kind: foreign files.

#include "catch.hpp"
#include "of_scenarios.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include "worlds/deformable/keys.hpp"

#include <filesystem>
#include <fstream>

namespace credence::test::ini_test {

namespace {

std::string refusal(const std::string& text, const Overrides& overrides = {}) {
    try {
        read_deformable_text(text, "x.ini", "x", overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool starts(const std::string& text, const std::string& with) { return text.compare(0, with.size(), with) == 0; }

}  // namespace

TEST_CASE("ini: an empty text is the default scenario, under the name given") {
    const DeformableSettings s = read_deformable_text("", "x.ini", "x");
    CHECK(s.name == "x");
    CHECK(s.poses == 20);
    CHECK(s.planner.speeds == 10);
    CHECK(s.planner.turns == std::vector<double>{0.0});
}

TEST_CASE("ini: sections, comments, blank lines, spaces and carriage returns are read") {
    const DeformableSettings s = read_deformable_text(
        "# a comment\r\n\n[scenario]\n name = abc # behind\n[model]\r\nprocess=translation\r\n"
        "\n[noise]\n  walk =  0.25 \n",
        "x.ini", "x");
    CHECK(s.name == "abc");
    CHECK(s.process == Process::translation);
    CHECK(s.noise.walk == 0.25);
}

TEST_CASE("ini: what scenario_text writes reads back to the same text") {
    DeformableSettings s;
    s.name = "round";
    s.title = "A title, with = signs [and] brackets";
    s.features.positions = {{0.1, -0.2}, {1e-3, 4}};
    s.edges = {EdgeGraph::list, {{0, 1}}};
    s.sensor.range_max = std::numeric_limits<double>::infinity();
    s.noise.truncate = 2;
    s.published.trace_P = {{"fixed.ekf", 0.1061}};
    const std::string text = scenario_text(resolved(s));
    CHECK(scenario_text(read_deformable_text(text, "x.ini", "x")) == text);
}

TEST_CASE("ini: overrides win, the last one most") {
    const DeformableSettings s =
        read_deformable_text("[noise]\nwalk = 1\n", "x.ini", "x", {{"noise.walk", "2"}, {"noise.walk", "3"}});
    CHECK(s.noise.walk == 3);
}

TEST_CASE("ini: a refusal names the file, the line and the key") {
    CHECK(starts(refusal("[noise]\nwalk = 1\nodometry = -1\n"),
                 "x.ini:3: invalid noise.odometry=-1 (must be at least 0"));
    CHECK(starts(refusal("[noise]\nwalk = nan\n"), "x.ini:2: invalid noise.walk=nan"));
    CHECK(starts(refusal("\n[noise]\nwlak = 1\n"), "x.ini:3: unknown key noise.wlak. Did you mean noise.walk?"));
    CHECK(starts(refusal("[noise]\nwalk = 1\n\nwalk = 2\n"),
                 "x.ini:4: repeated key noise.walk (it is in line 2 already)"));
    CHECK(starts(refusal("[noise]\nwalk = 1\n[sensor]\n[noise]\nwalk = 2\n"), "x.ini:5: repeated key noise.walk"));
    CHECK(starts(refusal("[noise]\njust some words\n"), "x.ini:2: broken line `just some words`"));
    CHECK(starts(refusal("[noise\nwalk = 1\n"), "x.ini:1: broken section `[noise`"));
    CHECK(starts(refusal("walk = 1\n"), "x.ini:1: unknown key walk"));
    CHECK(starts(refusal("[noise]\nwalk =\n"), "x.ini:2: invalid noise.walk="));
    CHECK(starts(refusal("[sensor]\nrange_min = 3\nrange_max = 2\n"),
                 "x.ini:3: invalid sensor.range_max=2 (must be above sensor.range_min=3)"));
    CHECK(starts(refusal("[scenario]\nposes = 1e99\n"), "x.ini:2: invalid scenario.poses=1e99"));
}

TEST_CASE("ini: a refused override names itself, and keys that contradict each other across file and override") {
    CHECK(starts(refusal("", {{"noise.walk", "-1"}}), "--set noise.walk: invalid noise.walk=-1"));
    CHECK(starts(refusal("[sensor]\nrange_min = 3\n"), "x.ini: invalid sensor.range_max=2"));
    CHECK(starts(refusal("[sensor]\nrange_max = 3\n", {{"sensor.range_min", "4"}}),
                 "x.ini:2: invalid sensor.range_max=3"));
}

TEST_CASE("ini: names, titles and units that a file could not hold are refused") {
    CHECK(starts(refusal("[scenario]\nname = run\n"), "x.ini:2: invalid scenario.name=run"));
    CHECK(starts(refusal("[scenario]\nname = a b\n"), "x.ini:2: invalid scenario.name=a b"));
    CHECK(starts(refusal("[scenario]\ntitle = \xff\n"), "x.ini:2: invalid scenario.title="));
    CHECK(starts(refusal("[scenario]\nlength_unit = \xc3\n"), "x.ini:2: invalid scenario.length_unit="));
    CHECK(starts(refusal("", {{"scenario.title", "a # b"}}), "--set scenario.title: invalid scenario.title=a # b"));
    CHECK(read_deformable_text("", "x.ini", "x", {{"scenario.title", " a "}}).title == "a");
}

TEST_CASE("ini: every refusal is one line") {
    for (const char* text : {"[noise]\nwalk = x\ty\n", "[a]\nb = c\n", "[\n", "= 3\n",
                             "[scenario]\ntitle = a\x01"
                             "b\n"}) {
        const std::string message = refusal(text);
        CHECK_FALSE(message.empty());
        CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("ini: files that cannot be read are refused by name") {
    CHECK_THROWS_WITH(read_deformable("no/such.ini"), Catch::Contains("no/such.ini"));
    CHECK_THROWS_WITH(read_deformable("."), Catch::Contains("it is not a file"));
    const std::string big = (std::filesystem::temp_directory_path() / "credence-big.ini").string();
    std::ofstream(big) << std::string((1 << 20) + 1, '#');
    CHECK_THROWS_WITH(read_deformable(big), Catch::Contains("larger than 1 MiB"));
    std::filesystem::remove(big);
}

TEST_CASE("ini: a file's stem is its default name, and must be a good one") {
    const auto folder = std::filesystem::temp_directory_path();
    const std::string good = (folder / "credence-name_1.ini").string(), bad = (folder / "credence bad.ini").string();
    std::ofstream(good) << "[noise]\nwalk = 1\n";
    std::ofstream(bad) << "[noise]\nwalk = 1\n";
    CHECK(read_deformable(good).name == "credence-name_1");
    CHECK_THROWS_WITH(read_deformable(bad), Catch::Contains("scenario.name"));
    std::filesystem::remove(good);
    std::filesystem::remove(bad);
}

}  // namespace credence::test::ini_test
