// `credence budget` on the command line.

#include "catch.hpp"
#include "program.hpp"

#include <nlohmann/json.hpp>

namespace credence::test::budget_cli_test {

using Catch::Contains;

TEST_CASE("cli: a budget is the same of a scenario, of a results file and of shards, in any lanes") {
    const Workplace here;
    here.write("small.ini", small_world);
    const Outcome direct = here.credence("budget small.ini --trials 600 --format json --quiet");
    REQUIRE(direct.exit_code == 0);
    CHECK(direct.err.empty());
    const auto arms = nlohmann::json::parse(direct.out);
    REQUIRE(arms.size() == 2);
    CHECK(arms[1]["arm"] == "greedy.ekf");
    CHECK(arms[0]["sources"] ==
          nlohmann::json({"odometry", "heading", "measurement", "walk", "deformation"}));
    CHECK(arms[0]["counted_trials"] == 256);

    const std::string run = "run small.ini --budget last --trials 600 --quiet ";
    REQUIRE(here.credence(run + "-o whole.h5").exit_code == 0);
    for (const char* shard : {"0/2", "1/2"})
        REQUIRE(here.credence(run + "--shard " + shard + " -o 'part-{shard}.h5'").exit_code == 0);
    check_refused(here.credence("budget part-0.h5"), "does not have all of its trials");
    REQUIRE(here.credence("merge part-0.h5 part-1.h5 -o merged.h5").exit_code == 0);
    for (const char* file : {"whole.h5", "merged.h5"})
        CHECK(here.credence(std::string("budget --format json ") + file).out == direct.out);
    CHECK(here.shell("CREDENCE_FORCE_TARGET=portable " CREDENCE_PROGRAM
                     " budget small.ini --trials 600 --format json --quiet --threads 2").out == direct.out);

    const Outcome text = here.credence("budget whole.h5 --of position");
    CHECK_THAT(text.out, Contains("error of position [dm] at the last step, by its sources: 600 trials of "
                                  "small/fixed.ekf") && Contains("P counts") && Contains("small/greedy.ekf"));
    CHECK_THAT(here.credence("budget whole.h5 --format csv").out, Contains("small,fixed.ekf,position,dm,odometry,"));
    REQUIRE(here.credence("budget whole.h5 --of position -o why.html").exit_code == 0);
    const std::string page = here.read("why.html");
    CHECK_THAT(page, Contains("Errors at the last step, by its sources: 600 trials of small/greedy.ekf.") &&
                         Contains("contributions to position") && Contains("odometry, P counts: "));
    CHECK_THAT(here.credence("budget small.ini --trials 300 --quiet --at mean").out,
               Contains("error of heading [rad] on average over the steps"));
    CHECK(here.credence("replay whole.h5 --scenario small-C-walk --arm fixed.ekf --trial 299").exit_code == 0);
}

TEST_CASE("cli: what no budget can be made of is refused before any work") {
    const Workplace here;
    here.write("small.ini", small_world);
    check_refused(here.credence("budget small.ini --of pose"),
                  "invalid --of=pose (there is no such component, or group of one unit). Take heading, position, feat");
    check_refused(here.credence("budget small.ini --trials 1"), "invalid --trials=1 (must be at least 2");
    check_refused(here.credence("budget small.ini --at first"), "--at");
    check_refused(here.credence("budget"), "no scenario given");
    check_refused(here.credence("show small.ini --set draws.other=heding"), "draws.other=heding");
    check_refused(here.credence("budget small.ini --set draws.other=heading"), "as the worlds of a budget do");
    REQUIRE(here.credence("run small.ini --trials 20 --quiet -o plain.h5").exit_code == 0);
    check_refused(here.credence("budget plain.h5"), "the study has no budget");
    check_refused(here.credence("budget plain.h5 --trials 30"), "--trials needs a scenario");
    check_refused(here.credence("run --resume --budget last -o plain.h5"), "--budget needs a scenario");
}

}  // namespace credence::test::budget_cli_test
