// Values that are accepted, and that may be a mistake.

#include "catch.hpp"
#include "program.hpp"

namespace credence::test::notes_test {

using Catch::Contains;

TEST_CASE("cli: a standard deviation of an angle above 1 rad is noted once, and used") {
    const Workplace here;
    here.write("small.ini", "[scenario]\nname = small\nposes = 3\n[noise]\nheading = 5\n");
    const std::string note =
        ": note: noise.heading=5 is a standard deviation in rad. If it is in degrees, give "
        "0.08726646259971647.\n";
    const Outcome shown = here.credence("show small.ini");
    CHECK(shown.exit_code == 0);
    CHECK(shown.err == "credence show" + note);
    CHECK_THAT(shown.out, Contains("heading = 5\n"));
    const Outcome planned = here.credence("run small.ini --trials 20 --dry-run --sweep 'noise.walk=0.1, 0.2'");
    CHECK(planned.exit_code == 0);
    CHECK(planned.err == "credence run" + note);
    const Outcome run = here.credence("run small.ini --trials 20 -o small.h5");
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("credence run" + note) == run.err.rfind(": note: ") - std::string("credence run").size());
    CHECK(here.credence("run small.ini --trials 20 -o quiet.h5 --quiet").err == "");
    CHECK(here.credence("show small.ini --set noise.heading=1 --set noise.walk=5").err == "");
    CHECK_THAT(here.credence("show --set scenario.world=explore --set noise.heading=2").err,
               Contains("noise.heading=2 is"));
}

}  // namespace credence::test::notes_test
