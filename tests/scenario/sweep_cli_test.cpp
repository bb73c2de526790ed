// Sweeps as the program's user meets them.

#include "catch.hpp"
#include "program.hpp"

#include <credence/text.hpp>

namespace credence::test::sweep_cli_test {

using Catch::Contains;

namespace {

/// A world of few poses and one arm, and a grid of two by two.
const std::string world = "[scenario]\nposes = 4\n[arms]\ncontrollers = fixed\n[planner]\nspeeds = 1\n",
                  grid = " --sweep noise.heading=0.01:0.1:2 --sweep sensor.noise=constant,ranged --quiet ";

}  // namespace

TEST_CASE("sweep: grown, and merged from shards, a grid is what it is run at once") {
    const Workplace here;
    here.write("base.ini", world);
    const auto run = [&](const std::string& options) {
        const Outcome outcome = here.credence("run base.ini" + grid + "--threads 1 " + options);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
    };
    run("--trials 600 -o once.h5");
    run("--trials 300 -o grown.h5");
    run("--trials 600 -o grown.h5 --resume");
    for (const char* part : {"0", "1"}) run("--trials 600 --shard " + std::string(part) + "/2 -o part" + part + ".h5");
    REQUIRE(here.credence("merge part1.h5 part0.h5 -o merged.h5").exit_code == 0);
    const std::string json = here.credence("report once.h5 --format json").out;
    CHECK_THAT(json, Contains("\"of\": \"base\"") && Contains("\"noise.heading\": 0.1") &&
                         Contains("\"sensor.noise\": \"ranged\""));
    for (const char* other : {"grown.h5", "merged.h5"})
        CHECK(here.credence("report " + std::string(other) + " --format json").out == json);
    check_refused(here.credence("run base.ini --sweep noise.heading=0.01:0.1:3 --trials 600 -o once.h5 --resume"),
                  "it has 4 scenarios, not 3");
}

TEST_CASE("sweep: show prints every point as a scenario that runs, and a dry run counts them") {
    const Workplace here;
    here.write("base.ini", world);
    const Outcome shown = here.credence("show base.ini --sweep noise.heading=0.01,0.1 --set noise.walk=0.2");
    CHECK(shown.exit_code == 0);
    CHECK_THAT(shown.out, Contains("# 1 of 2: base_heading-0p01\n[scenario]\nname = base_heading-0p01\n"));
    CHECK_THAT(shown.out, Contains("\n# 2 of 2: base_heading-0p1\n"));
    CHECK_THAT(shown.out, Contains("[sweep]\nof = base\nat = noise.heading=0.1\n"));
    REQUIRE(here.shell(CREDENCE_PROGRAM " show base.ini --sweep noise.heading=0.1 >point.ini").exit_code == 0);
    CHECK(here.credence("show point.ini").out == here.read("point.ini"));
    CHECK_THAT(here.credence("run base.ini --dry-run" + grid).out, Contains("scenarios: 4, "));
    CHECK(here.names() == std::vector<std::string>{"base.ini", "point.ini"});
}

TEST_CASE("sweep: bad sweeps are refused in one line with exit code 2, and nothing is written") {
    const Workplace here;
    here.write("base.ini", world);
    here.write("other.ini", world);
    const std::vector<std::pair<std::string, std::string>> cases{
        {"run base.ini --sweep noise.heading", "invalid --sweep=noise.heading (there is no = in it)"},
        {"run base.ini --sweep noise.heding=1", "Did you mean noise.heading?"},
        {"run base.ini --sweep noise.heading=1,0", "base.ini at noise.heading=0: invalid noise.heading=0"},
        {"run base.ini --sweep scenario.name=a,b", "scenario.name changes nothing"},
        {"run base.ini base.ini --sweep noise.heading=1,2", "two scenarios of the run have it"},
        {"run base.ini other.ini --sweep noise.heading=1:501:501", "1002 scenarios"},
        {"run base.ini --sweep noise.heading=1:50:50 --sweep noise.walk=1:50:50", "more than 1000 points"},
        {"show --sweep noise.heading=1", "--sweep needs a scenario"}};
    for (const auto& [arguments, why] : cases) check_refused(here.credence(arguments), why);
    CHECK(here.names() == std::vector<std::string>{"base.ini", "other.ini"});
}

}  // namespace credence::test::sweep_cli_test
