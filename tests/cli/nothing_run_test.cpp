// What the program says without running anything: scenarios as resolved, dry runs, help, and runs that cannot fit.
// Kind: foreign files.

#include "catch.hpp"
#include "program.hpp"

namespace credence::test::nothing_run_test {

using Catch::Contains;

TEST_CASE("cli: show prints a scenario that reads back to itself") {
    const Workplace here;
    const Outcome shown = here.credence("show " + seed_scenario("kf-circle-ranged") + " --set noise.walk=0.25");
    REQUIRE(shown.exit_code == 0);
    CHECK_THAT(shown.out, Contains("walk = 0.25") && Contains("[published]") && Contains("speeds = 5"));
    here.write("kf-circle-ranged.ini", shown.out);
    CHECK(here.credence("show kf-circle-ranged.ini").out == shown.out);
    CHECK_THAT(here.credence("show").out, Contains("noise.heading = 0.001"));
    here.write("defaults.ini", here.credence("show --set scenario.world=explore").out);
    CHECK_THAT(here.credence("show defaults.ini").out, Contains("world = explore") && Contains("view = 6.28"));
}

TEST_CASE("cli: a dry run says what to expect and writes nothing") {
    const Workplace here;
    const Outcome dry = here.credence("run " + seed_scenario("ekf-straight-constant") + " --trials 1e6 --dry-run");
    CHECK(dry.exit_code == 0);
    CHECK_THAT(dry.out, Contains("trials of each: 1000000") && Contains("of memory") && Contains("in credence.h5"));
    CHECK(here.names().empty());
}

TEST_CASE("cli: help for every command, and the version with the facts of the build") {
    const Workplace here;
    CHECK_THAT(here.credence("--help").out,
               Contains("run") && Contains("report") && Contains("replay") && Contains("show"));
    for (const char* command : {"run", "report", "replay", "show"}) {
        const Outcome help = here.credence(std::string(command) + " --help");
        CHECK(help.exit_code == 0);
        CHECK_THAT(help.out, Contains(std::string("usage: credence ") + command));
    }
    const Outcome version = here.credence("--version");
    CHECK(version.exit_code == 0);
    CHECK_THAT(version.out, Contains("credence ") && Contains("compiler") && Contains("instruction_set") &&
                                Contains("schema_version"));
}

TEST_CASE("cli: a run that cannot fit is refused before any work, unless --force is given") {
    const Workplace here;
    here.write("small.ini", "[scenario]\nname = small\nposes = 3\n");
    const std::string run = CREDENCE_PROGRAM " run small.ini --quiet -o x.h5 --threads 1 ";
    check_refused(here.shell(run + "--trials 1e12"),
                  "are there). Ask for less, see --dry-run, or start it all the same with --force.");
#ifndef CREDENCE_SANITIZED  // which takes terabytes of addresses
    check_refused(here.shell("ulimit -v 400000; " + run + "--set scenario.poses=20000 --trials 256"), "of memory (");
#endif
    CHECK(here.names() == std::vector<std::string>{"small.ini"});
    CHECK(here.shell(run + "--trials 1e12 --dry-run").exit_code == 0);
    CHECK(here.shell("timeout -s INT 0.5 " + run + "--trials 1e12 --force").exit_code == 124);
}

}  // namespace credence::test::nothing_run_test
