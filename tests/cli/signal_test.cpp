// Signals stop a run with everything kept.

#include <credence/detail/store.hpp>

#include "catch.hpp"
#include "program.hpp"

namespace credence::test::signal_test {

using Catch::Contains;

namespace {

const std::string small_world =
    "[scenario]\nname = small\nposes = 5\n[arms]\ncontrollers = fixed\n[planner]\nspeeds = 1\n";
/// A scenario whose blocks of 256 trials take some tenths of a second each.
const std::string slow_world = "[scenario]\nname = slow\nposes = 400\n";

/// A run in the background, of which `signals` is done once its journal has a block or more; then its exit code.
Outcome disturbed(const Workplace& here, const std::string& arguments, const std::string& signals,
                  const std::string& before = "") {
    return here.shell(before + CREDENCE_PROGRAM " run " + arguments + " & run=$!\n" +
                      "until [ \"$(stat -c %s x.h5.journal 2>/dev/null || echo 0)\" -gt 20000 ] || ! kill -0 $run; do "
                      "sleep 0.01; done\n" +
                      signals + "\nwait $run; echo exit code $?");
}

}  // namespace

TEST_CASE("cli: a signal stops the run with everything kept, and the line that it prints goes on") {
    for (const std::string name : {"INT", "TERM", "HUP"}) {
        const Workplace here;
        here.write("small world.ini", small_world);
        // As many trials as would take hours.
        const std::string arguments =
            "'small world.ini' --trials 1e8 --force --quiet -o x.h5 --commit-every 1 --threads 2";
        const Outcome stopped = disturbed(here, arguments, "kill -" + name + " $run");
        CAPTURE(name, stopped.err);
        CHECK(stopped.out == "exit code 3\n");
        CHECK_THAT(stopped.err,
                   Contains("credence run: stopped by SIG" + name + " with ") &&
                       Contains("trials kept in x.h5 (complete = 0). To resume it:\n  " CREDENCE_PROGRAM
                                " run"));
        CHECK(here.names() == std::vector<std::string>{"small world.ini", "x.h5"});
        const Study study = read_results(here.path("x.h5")).study;
        CHECK_FALSE(study.complete);
        CHECK(study.scenarios.front().trials >= 256);
        CHECK(here.shell(CREDENCE_PROGRAM " report x.h5").exit_code == 0);
        // The line itself, but for its number of trials, which is beyond a test's time.
        std::string line = stopped.err.substr(stopped.err.find("\n  ") + 3);
        line = line.substr(0, line.find('\n'));
        CHECK_THAT(line, Contains("'small world.ini'") && Contains(" --resume"));
        const Outcome again =
            here.shell("PATH=$(dirname " CREDENCE_PROGRAM "):$PATH\n" + line + " & run=$!\n" +
                       "until [ -s x.h5.journal ] || ! kill -0 $run; do sleep 0.01; done; kill -TERM $run; wait $run");
        CHECK(again.exit_code == 3);
        const Study more = read_results(here.path("x.h5")).study;
        CHECK(more.scenarios.front().trials >= study.scenarios.front().trials);
    }
}

TEST_CASE("cli: the command that a stopped run prints gives the results of an undisturbed run", "[long]") {
    const Workplace here;
    here.write("slow.ini", slow_world);
    const std::string arguments = "slow.ini --trials 2100 --quiet --commit-every 1 --threads 2 ";
    const Outcome stopped = disturbed(here, arguments + "-o x.h5", "kill -TERM $run");
    CAPTURE(stopped.err);
    REQUIRE(stopped.out == "exit code 3\n");
    std::string line = stopped.err.substr(stopped.err.find("\n  ") + 3);
    CHECK(here.shell("PATH=$(dirname " CREDENCE_PROGRAM "):$PATH\n" + line).exit_code == 0);
    REQUIRE(here.credence("run " + arguments + "-o whole.h5").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run whole.h5 x.h5").exit_code == 0);
}

TEST_CASE("cli: a second signal ends the run at once, and nothing committed is lost", "[long]") {
    const Workplace here;
    here.write("slow.ini", slow_world);
    const std::string arguments = "slow.ini --trials 2100 --quiet --commit-every 1 --threads 2 ";
    const Outcome ended = disturbed(here, arguments + "-o x.h5", "kill -TERM $run; kill -INT $run");
    CAPTURE(ended.err);
    CHECK(ended.out == "exit code 130\n");
    CHECK(ended.err.empty());
    CHECK(here.names() == std::vector<std::string>{"slow.ini", "x.h5.journal"});
    CHECK(here.credence("run " + arguments + "-o x.h5 --resume").exit_code == 0);
    REQUIRE(here.credence("run " + arguments + "-o whole.h5").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run whole.h5 x.h5").exit_code == 0);
}

TEST_CASE("cli: a SIGHUP that nohup ignores stays ignored") {
    const Workplace here;
    here.write("small.ini", small_world);
    const Outcome run =
        disturbed(here, "small.ini --trials 1e8 --force --quiet -o x.h5 --commit-every 1",
                  "kill -HUP $run; sleep 0.1; kill -HUP $run; sleep 0.1; kill -TERM $run", "trap '' HUP\n");
    CAPTURE(run.err);
    CHECK(run.out == "exit code 3\n");
    CHECK_THAT(run.err, Contains("stopped by SIGTERM"));
}

TEST_CASE("cli: a signal while the results file is written does not leave half of it", "[long]") {
    const Workplace here;
    here.write("small.ini", small_world);
    for (const char* delay : {"0", "0.05", "0.1", "0.2", "0.3"}) {
        const Outcome run =
            here.shell(std::string(CREDENCE_PROGRAM " run small.ini --trials 200000 --quiet -o x.h5 --threads 2 & "
                                                    "run=$!; sleep ") +
                       delay + "; kill -TERM $run; wait $run");
        CAPTURE(delay, run.err);
        // Before the program catches it, it ends the program; after the run's end there is nothing to stop.
        CHECK((run.exit_code == 0 || run.exit_code == 3 || run.exit_code == 143));
        CHECK(here.credence("run small.ini --trials 200000 --quiet -o x.h5 --resume").exit_code == 0);
        CHECK(here.names() == std::vector<std::string>{"small.ini", "x.h5"});
        CHECK(read_results(here.path("x.h5")).study.complete);
        here.shell("rm x.h5");
    }
}

TEST_CASE("cli: run --until that was killed and goes on stops where it would have stopped", "[long]") {
    const Workplace here;
    here.write("small.ini", small_world);
    const std::string arguments = "small.ini --until trace_P=0.5% --trials 2e6 --quiet --commit-every 1 --threads 2 ";
    REQUIRE(here.credence("run " + arguments + "-o whole.h5").exit_code == 0);
    REQUIRE(read_results(here.path("whole.h5")).study.trials < 1000000);
    const Outcome killed = disturbed(here, arguments + "-o x.h5", "kill -KILL $run");
    REQUIRE(killed.out == "exit code 137\n");
    CHECK(here.credence("run " + arguments + "-o x.h5 --resume").exit_code == 0);
    CHECK(here.shell("h5diff --exclude-path /run whole.h5 x.h5").exit_code == 0);
}

}  // namespace credence::test::signal_test
