// A program that is started with its standard streams closed.

#include "catch.hpp"
#include "program.hpp"

#include <filesystem>

namespace credence::test::streams_test {

using Catch::Contains;

namespace {

bool holds(const std::string& bytes, const std::string& text) { return bytes.find(text) != std::string::npos; }

}  // namespace

TEST_CASE("cli: what a library prints on a closed error stream gets into no file") {
    const Workplace here;
    here.write("small.ini", small_world);
    // Eight threads with stacks of 1 GB have no room in 4 GB, though two have: OpenMP's library says so and ends the
    // process while the journal is open.
    for (const std::string closed : {"2>&-", "<&- >&- 2>&-", ">&- 2>&-"}) {
        CAPTURE(closed);
        const std::string run = CREDENCE_PROGRAM " run small.ini --trials 700 --quiet -o x.h5 ";
        here.shell("ulimit -v 4000000; OMP_STACKSIZE=1G " + run + "--threads 8 --resume " + closed);
        const bool ended = holds(here.read("x.h5"), "HDF");
        if (!ended) CHECK(here.read("x.h5.journal").starts_with("credence-journal"));
        CHECK_FALSE(holds(here.read("x.h5.journal"), "libgomp"));
        CHECK(here.shell(run + "--resume " + closed).exit_code == 0);
        CHECK_FALSE(holds(here.read("x.h5"), "libgomp"));
        CHECK(here.shell(CREDENCE_PROGRAM " report x.h5").exit_code == 0);
        CHECK(here.names() == std::vector<std::string>{"small.ini", "x.h5"});
        std::filesystem::remove(here.path("x.h5"));
    }
}

TEST_CASE("cli: output that a closed stream loses is a failure, and nothing is read from a closed input") {
    const Workplace here;
    here.write("small.ini", small_world);
    const Outcome lost = here.shell(CREDENCE_PROGRAM " show small.ini >&-");
    CHECK(lost.exit_code == 1);
    CHECK_THAT(lost.err, Contains("cannot write to the standard output"));
    CHECK(here.shell(CREDENCE_PROGRAM " show small.ini >&- 2>&-").exit_code == 1);
    CHECK(here.shell(CREDENCE_PROGRAM " show small.ini <&- 2>&-").exit_code == 0);
}

}  // namespace credence::test::streams_test
