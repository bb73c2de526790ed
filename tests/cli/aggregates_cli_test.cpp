// `--keep aggregates` on the command line.

#include "catch.hpp"
#include "program.hpp"

#include <nlohmann/json.hpp>

namespace credence::test::aggregates_cli_test {

using Catch::Contains;

TEST_CASE("cli: a study of aggregates is run, resumed, reported, compared, followed and replayed") {
    const Workplace here;
    const std::string run = "run " + seed_scenario("kf-straight-constant") + " --set scenario.poses=4 --quiet ";
    REQUIRE(here.credence(run + "--trials 300 --keep aggregates -o x.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 600 --keep aggregates --resume -o x.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 600 --keep aggregates -o once.h5").exit_code == 0);
    REQUIRE(here.credence(run + "--trials 600 --keep trials -o trials.h5").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run x.h5 once.h5").exit_code == 0);

    const auto report = [&](const std::string& file) {
        return nlohmann::json::parse(here.credence("report " + file + " --format json").out);
    };
    const auto totals = report("x.h5"), trials = report("trials.h5");
    CHECK(totals[0]["trials"] == 600);
    CHECK(totals[0]["verdict"] == trials[0]["verdict"]);
    CHECK(totals[1]["unseen"]["mean"] == trials[1]["unseen"]["mean"]);
    CHECK(totals[1]["unseen"]["median"].is_null());
    CHECK_THAT(here.credence("compare x.h5").out, Contains("greedy.kf - fixed.kf, trial by trial: 600 pairs"));
    CHECK_THAT(here.credence("watch x.h5").out, Contains("complete, 600 trials"));
    const std::string trial = " --scenario kf-straight-constant --arm greedy.kf --trial 599 --format json";
    const Outcome replayed = here.credence("replay x.h5" + trial);
    CHECK(replayed.exit_code == 0);
    CHECK(replayed.out == here.credence("replay trials.h5" + trial).out);
    CHECK(here.credence("replay x.h5 --scenario kf-straight-constant --arm greedy.kf --trial 600").exit_code == 2);

    check_refused(here.credence(run + "--trials 900 --resume -o x.h5"), "it keeps aggregates, not trials");
    check_refused(here.credence("compare x.h5 once.h5"), "keeps aggregates");
    CHECK(here.credence(run + "--trials 3 --keep all -o y.h5").exit_code == 2);
}

TEST_CASE("cli: a billion trials of which none is kept are expected to take no more memory or file than a million") {
    const Workplace here;
    const auto expected = [&](const std::string& trials) {
        const std::string out = here.credence("run " + seed_scenario("kf-straight-constant") +
                                              " --keep aggregates --dry-run --trials " + trials)
                                    .out;
        return out.substr(out.find(", ", out.find("About")));  // behind the time
    };
    CHECK(expected("1e9") == expected("1e6"));
    CHECK_THAT(expected("1e9"), Contains("MB in credence.h5, as much in its journal at every commit"));
}

}  // namespace credence::test::aggregates_cli_test
