// What the planner executes costs no more than the least that the plain form finds, in scenarios drawn at random.

#include "catch.hpp"
#include "hard_planning.hpp"

#include <cstdlib>

namespace credence::test::planner_hard_long_test {

namespace {

/// CREDENCE_HARD_SCENARIOS is how many are tried by hand; else null.
const char* const many = std::getenv("CREDENCE_HARD_SCENARIOS");

unsigned hard_scenarios(unsigned fewer) { return many != nullptr ? static_cast<unsigned>(std::atoi(many)) : fewer; }

/// Those that are decided by the plain form's own costs, or by ones that differ by rounding alone.
const std::vector<Settings> without_trace{{{"planner.criterion", "log_det"}},
                                          {{"planner.criterion", "pose_log_det"}},
                                          {{"planner.criterion", "max_eigenvalue"}}};

/// Scenarios matter here, not steps.
Settings with_poses(Settings settings, const char* poses) {
    settings.emplace_back("scenario.poses", poses);
    return settings;
}

/// Of many, some have eigenvalues that differ by rounding alone, which the plain form's bisection rounds otherwise.
bool may_tie(const Settings& settings) {
    return many != nullptr && settings.front() == Settings::value_type{"planner.criterion", "max_eigenvalue"};
}

template <class Real>
void check_same(unsigned count, Settings more) {
    CAPTURE(described(more), lanes<Real>);
    const Tally tally = run_random<Real>(count, more);
    CHECK(tally.different == (may_tie(more) ? tally.tied : 0));
    CHECK(tally.dearer == 0);
    CHECK(tally.scenarios > static_cast<int>(count * 3 / 4));
    CHECK(tally.steps > tally.scenarios);
    CHECK(tally.planned == tally.steps);
}

template <class Real>
void check_random(unsigned count, const Settings& more = {}) {
    CAPTURE(described(more));
    const Tally tally = run_random<Real>(count, more);
    CHECK(tally.dearer == 0);
    CHECK(tally.scenarios > static_cast<int>(count * 3 / 4));
    CHECK(tally.steps > tally.scenarios);
    CHECK(tally.planned == tally.steps);
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
    check_random<Lane<4>>(100);
    check_random<Lane<8>>(100);
}

TEST_CASE("planner: by every criterion no control costs more than the least, on 300 random hard scenarios") {
    for (const Settings& criterion : criteria()) check_random<double>(300, with_poses(criterion, "4"));
}

TEST_CASE("planner: by every criterion no control costs more than the least, on 10 random hard scenarios in lanes") {
    for (const Settings& criterion : criteria()) check_random<Lane<8>>(10, criterion);
}

TEST_CASE("planner: by every criterion that is no trace the control is the plain form's, in every lane width") {
    for (const Settings& all_steps : without_trace) {
        const Settings criterion = many != nullptr ? with_poses(all_steps, "4") : all_steps;
        check_same<double>(hard_scenarios(40), criterion);
        check_same<Lane<4>>(hard_scenarios(10), criterion);
        check_same<Lane<8>>(hard_scenarios(10), criterion);
    }
}

TEST_CASE("planner: by every criterion that is no trace, two and three steps ahead, the control is brute force's") {
    for (const Settings& criterion : without_trace)
        for (const char* steps : {"2", "3"}) {
            Settings ahead = with_poses(criterion, "5");
            ahead.insert(ahead.end(), {{"arms.controllers", "horizon"}, {"planner.horizon", steps},
                                       {"planner.speeds", "1"}});
            check_same<double>(hard_scenarios(20) / 10, ahead);
            check_same<Lane<8>>(hard_scenarios(10) / 10, ahead);
        }
}

}  // namespace credence::test::planner_hard_long_test
