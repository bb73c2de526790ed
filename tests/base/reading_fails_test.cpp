// A disk that cannot be read in the middle of a file [reading_fails.c].

#include "catch.hpp"
#include "judgement_support.hpp"
#include "program.hpp"

namespace credence::test::reading_fails_test {

using Catch::Contains;

TEST_CASE("cli: a disk that fails in the middle of a file is what the message says, not that something is missing") {
    const Workplace here;
    REQUIRE(
        here.credence("run " + seed_scenario("ekf-straight-constant") + " --trials 300 --quiet -o x.h5").exit_code ==
        0);
    write_plain_record(here.path("record.h5"));
    const auto check = [&](const std::string& command, const std::string& file, int from) {
        const Outcome outcome =
            here.shell("LD_PRELOAD=" CREDENCE_READING_FAILS " READING_FAILS=" + file +
                       " READING_FAILS_FROM=" + std::to_string(from) + " " CREDENCE_PROGRAM " " + command + " " + file);
        CAPTURE(command, from);
        check_refused(outcome, "cannot be read (input/output error). Check the disk.");
    };
    for (const int from : {4, 100, 1000, 5000, 50000})
        for (const std::string command : {"report", "compare", "watch"}) check(command, "x.h5", from);
    for (const int from : {4, 700, 2500}) check("judge --quiet", "record.h5", from);
}

TEST_CASE("cli: a journal that the system cannot read back is said to be that, not to be changed by another program") {
    const Workplace here;
    const Outcome outcome = here.shell("LD_PRELOAD=" CREDENCE_READING_FAILS
                                       " READING_FAILS=x.h5.journal "
                                       "READING_FAILS_FROM=900 " CREDENCE_PROGRAM " run " +
                                       seed_scenario("ekf-straight-constant") + " --trials 300 --quiet -o x.h5");
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Contains("x.h5.journal: cannot be read (input/output error). Check the disk."));
}

TEST_CASE("cli: what a crash left behind and cannot be removed ends the run with a message, and the journal goes on") {
    const Workplace here;
    here.write("x.h5.credence-partial", "left");
    const std::string run = "run " + seed_scenario("ekf-straight-constant") + " --trials 300 --quiet -o x.h5";
    const Outcome outcome = here.shell("LD_PRELOAD=" CREDENCE_READING_FAILS " REMOVING_FAILS=x.h5.credence-partial "
                                       "timeout 20 " CREDENCE_PROGRAM " " + run);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err,
               Contains("cannot write x.h5 (operation not permitted). Write to a folder that you may write"));
    CHECK(here.credence(run + " --resume").exit_code == 0);
    CHECK(here.names() == std::vector<std::string>{"x.h5"});
}

}  // namespace credence::test::reading_fails_test
