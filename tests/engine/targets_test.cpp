// The selection of the target, and that it does not change the results. That targets agree to the bit: block_test.cpp,
// and tests/digest.

#include "worlds/simulate.hpp"
#include <credence/study.hpp>
#include <fstream>
#include <sstream>

#include "catch.hpp"
#include "program.hpp"
#include "of_scenarios.hpp"

namespace credence::test::targets_test {

using Catch::Contains;

namespace {

/// Runs the program with the environment variable set to `unit`.
Outcome forced(const Workplace& here, const std::string& target, const std::string& arguments) {
    return here.shell("CREDENCE_FORCE_TARGET='" + target + "' " CREDENCE_PROGRAM " " + arguments);
}

std::string source_file(const std::string& name) {
    std::ifstream stream(std::string(CREDENCE_SOURCE) + "/" + name);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool runs_here(const std::string& name) {
    for (const Target& target : runnable_targets())
        if (target.name == name) return true;
    return false;
}

}  // namespace

TEST_CASE("targets: --version says which one runs, and the variable chooses it") {
    const Workplace here;
    CHECK_THAT(here.shell("env -u CREDENCE_FORCE_TARGET " CREDENCE_PROGRAM " --version").out,
               Contains("instruction_set: " + runnable_targets().front().name + "\n"));
    for (const Target& target : runnable_targets()) {
        const Outcome version = forced(here, target.name, "--version");
        CHECK(version.exit_code == 0);
        CHECK_THAT(version.out, Contains("instruction_set: " + target.name + "\n"));
        CHECK_THAT(version.out, Contains("lane_width: " + std::to_string(target.lanes) + "\n"));
    }
}

TEST_CASE("targets: one that is unknown or that the processor cannot run is refused before any work") {
    const Workplace here;
    for (const std::string name : {"", "v5", "V3", "portable ", "v3", "v4"}) {
        if (runs_here(name)) continue;
        CAPTURE(name);
        for (const std::string& arguments : {"run " + seed_scenario("ekf-straight-constant") + " --trials 10",
                                             std::string("show"), std::string("--version")}) {
            const Outcome refused = forced(here, name, arguments);
            check_refused(refused, "invalid CREDENCE_FORCE_TARGET=" + name + " (");
            CHECK_THAT(refused.err, Contains("portable.\n"));
        }
    }
    CHECK(here.names().empty());
    CHECK(forced(here, "v5", "--help").exit_code == 0);
}

TEST_CASE("targets: each writes the same results, and /run says which one did") {
    const Workplace here;
    const std::string study = "run " + seed_scenario("ekf-straight-ranged") + " " +
                              seed_scenario("kf-circle-constant") + " --trials 300 --threads 2 --quiet -o ";
    for (const Target& target : runnable_targets()) {
        CAPTURE(target.name);
        REQUIRE(forced(here, target.name, study + target.name + ".h5").exit_code == 0);
        CHECK_THAT(here.shell("h5dump -a /run/instruction_set " + target.name + ".h5").out,
                   Contains("\"" + target.name + "\""));
    }
    for (const Target& target : runnable_targets())
        CHECK(here.shell("h5diff --exclude-path /run portable.h5 " + target.name + ".h5").exit_code == 0);
}

TEST_CASE("targets: the committed digest is of this version of the draws, and the changelog has it") {
    const std::string schema = "schema " + std::to_string(draws_version);
    CHECK(source_file("tests/digest/expected.txt").starts_with(schema + "\n"));
    CHECK_THAT(source_file("CHANGELOG.md"), Contains("(" + schema + ")"));
}

}  // namespace credence::test::targets_test
