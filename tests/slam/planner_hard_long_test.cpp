// What the planner executes costs no more than the least that the plain form finds, in scenarios drawn at random.

#include "catch.hpp"
#include "hard_planning.hpp"

using namespace credence;
using namespace credence::test;

namespace {

template <class Real>
void check_random(unsigned count, const Settings& more = {}) {
    CAPTURE(described(more));
    const Tally tally = run_random<Real>(count, more);
    CHECK(tally.dearer == 0);
    CHECK(tally.scenarios > static_cast<int>(count * 3 / 4));
    CHECK(tally.steps > tally.scenarios);
}

}  // namespace

TEST_CASE("planner: no control costs more than the least, on eight features and a robot that loses itself") {
    Tally tally;
    for (const char* process : {"heading", "translation"})
        run_scenario<Lane<8>>({{"model.process", process},
                               {"features.positions",
                                "1 0, 0.7 0.7, 0 1, -0.7 0.7, -1 0, -0.7 -0.7, 0 -1, 0.7 -0.7"},
                               {"features.path", "circle"},
                               {"scenario.poses", "30"},
                               {"noise.odometry", "1"},
                               {"noise.walk", "0.01"},
                               {"noise.deformation", "0.01"}},
                              tally);
    CHECK(tally.steps == 2 * 8 * 29);
    CHECK(tally.dearer == 0);
}

TEST_CASE("planner: no control costs more than the least, on 1,500 random hard scenarios") {
    check_random<double>(1500);
}

TEST_CASE("planner: no control costs more than the least, on 100 random hard scenarios in every lane width") {
    check_random<Lane<2>>(100);
    check_random<Lane<4>>(100);
    check_random<Lane<8>>(100);
}

TEST_CASE("planner: by every criterion no control costs more than the least, on 300 random hard scenarios") {
    for (Settings criterion : criteria()) {
        criterion.emplace_back("scenario.poses", "4");  // scenarios matter here, not steps
        check_random<double>(300, criterion);
    }
}

TEST_CASE("planner: by every criterion no control costs more than the least, on 10 random hard scenarios in lanes") {
    for (const Settings& criterion : criteria()) check_random<Lane<8>>(10, criterion);
}
