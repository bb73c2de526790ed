// `credence watch` as its user meets it.

#include "catch.hpp"
#include "program.hpp"

#include <nlohmann/json.hpp>

namespace credence::test::watch_cli_test {

using Catch::Contains;
using Json = nlohmann::json;

namespace {

/// A study of two arms that runs for a second or more, in the background until its journal has a commit.
const std::string begun_run =
    CREDENCE_PROGRAM " run slow.ini --trials 1100 --quiet --commit-every 1 --threads 1 -o x.h5 & run=$!\n"
    "until [ \"$(stat -c %s x.h5.journal 2>/dev/null || echo 0)\" -gt 100000 ] || ! kill -0 $run; do sleep 0.01; "
    "done\n";

Workplace& with_slow_world(Workplace& here) {
    here.write("slow.ini", "[scenario]\nname = slow\nposes = 400\n");
    return here;
}

}  // namespace

TEST_CASE("cli: watch follows a run to its end, and then says what report says") {
    Workplace here;
    with_slow_world(here);
    const Outcome both = here.shell(begun_run + CREDENCE_PROGRAM " watch x.h5 >first.txt; " CREDENCE_PROGRAM
                                                                 " watch x.h5.journal --format json >first.json; "
                                                                 "wait $run; echo exit code $?");
    CAPTURE(both.err);
    REQUIRE(both.out == "exit code 0\n");
    const std::string first = here.read("first.txt");
    CHECK_THAT(first, Contains("x.h5: running, ") && Contains(" of 1100 trials (") && Contains("last commit ") &&
                          Contains("slow: ") && Contains("  fixed.ekf ") && Contains("  greedy.ekf - fixed.ekf "));
    const Json running = Json::parse(here.read("first.json"));
    REQUIRE(running.size() == 2);
    CHECK(running[0]["state"] == "running");
    CHECK(running[0]["trials"] >= 256);
    CHECK(running[0]["trials"] < 1100);
    CHECK(running[0]["trials_asked"] == 1100);

    const Outcome last = here.credence("watch x.h5 --format json"), report = here.credence("report x.h5 --format json");
    REQUIRE(last.exit_code == 0);
    const Json said = Json::parse(last.out), reported = Json::parse(report.out);
    for (std::size_t arm = 0; arm < 2; ++arm) {
        CHECK(said[arm]["state"] == "complete");
        CHECK(said[arm]["failed"] == reported[arm]["failed"]);
        // The same sums in another order: some roundings.
        for (const char* figure : {"trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio"}) {
            CHECK(said[arm][figure]["mean"].get<double>() ==
                  Approx(reported[arm][figure]["mean"].get<double>()).epsilon(1e-13));
            for (const std::size_t end : {0u, 1u})
                CHECK(said[arm][figure]["ci95"][end].get<double>() ==
                      Approx(reported[arm][figure]["ci95"][end].get<double>()).epsilon(1e-12));
            CHECK(said[arm][figure]["unit"] == reported[arm][figure]["unit"]);
        }
    }
    CHECK(said[1]["paired_difference"]["pair"] == "greedy.ekf - fixed.ekf");
    CHECK(said[1]["paired_difference"]["trace_P"]["mean"].get<double>() ==
          Approx(reported[1]["paired_difference"]["trace_P"]["mean"].get<double>()).epsilon(1e-12));
    const Outcome text = here.credence("watch x.h5");
    CHECK_THAT(text.out, Contains("x.h5: complete, 1100 trials\n"));
}

TEST_CASE("cli: on a terminal watch draws until the run ends, and Ctrl-C ends it") {
    Workplace here;
    with_slow_world(here);
    if (here.shell("command -v script").exit_code != 0) {
        WARN("SKIPPED: script (bsdutils) is not installed");
        return;
    }
    const std::string on_terminal = "export TERM=xterm SHELL=/bin/sh\nscript -qec '";
    const Outcome to_end = here.shell(begun_run + on_terminal + CREDENCE_PROGRAM
                                      " watch x.h5 --every 0.1' drawn </dev/null >/dev/null; echo exit code $?; "
                                      "wait $run");
    CHECK(to_end.out == "exit code 0\n");
    const std::string drawn = here.read("drawn");
    const std::size_t end = drawn.find("\033[?1049l");
    REQUIRE(end != std::string::npos);
    CHECK_THAT(drawn.substr(0, end), Contains("\033[?1049h") && Contains("\033[H\033[Jx.h5: running, "));
    CHECK_THAT(drawn.substr(end), Contains("x.h5: complete, 1100 trials"));

    here.shell("rm x.h5");
    const Outcome stopped =
        here.shell(begun_run + on_terminal + CREDENCE_PROGRAM " watch x.h5 & watch=$!; sleep 0.3; kill -INT $watch; "
                   "wait $watch' drawn </dev/null >/dev/null; echo exit code $?; kill -KILL $run; wait $run");
    CHECK(stopped.out == "exit code 3\n");
    const std::string left = here.read("drawn");
    CHECK_THAT(left.substr(left.find("\033[?1049l")), Contains("x.h5: running, "));
}

TEST_CASE("cli: watch refuses what it cannot follow") {
    const Workplace here;
    for (const auto& [arguments, why] : std::vector<std::pair<std::string, std::string>>{
             {"", "watch takes one results file"},
             {"none.h5", "nothing to watch: neither none.h5 nor none.h5.journal is there. Check the name, or begin"},
             {"none.h5 --every 0", "invalid --every=0"},
             {"none.h5 --every often", "invalid --every=often"},
             {"none.h5 --format csv", "invalid --format=csv"}})
        check_refused(here.credence("watch " + arguments), why);
}

}  // namespace credence::test::watch_cli_test
