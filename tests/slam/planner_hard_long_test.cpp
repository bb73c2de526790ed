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

Tally check_random(unsigned count, const Settings& more = {}) {
    CAPTURE(described(more));
    const Tally tally = run_random(count, more);
    CHECK(tally.dearer == 0);
    CHECK(tally.scenarios > static_cast<int>(count * 3 / 4));
    CHECK(tally.steps > tally.scenarios);
    CHECK(tally.planned == tally.steps);
    return tally;
}

void check_same(unsigned count, const Settings& more) {
    CAPTURE(described(more));
    const Tally tally = check_random(count, more);
    CHECK(tally.different == (may_tie(more) ? tally.tied : 0));
}

/// The targets' lanes plan as one trial at a time does.
void check_lanes(unsigned count, const Settings& more) {
    unsigned scenarios = 0;
    each_random(count, more, [&](const Settings& settings) {
        const Problem problem(scenario_with(settings));
        CAPTURE(described(settings));
        CHECK(other_bits_in_lanes(problem) == std::vector<std::string>{});
        ++scenarios;
    });
    CHECK(scenarios > count * 3 / 4);
}

}  // namespace

TEST_CASE("planner: no control costs more than the least, on eight features and a robot that loses itself") {
    Tally tally;
    for (const char* process : {"heading", "translation"})
        run_scenario({{"model.process", process},
                      {"features.positions", "1 0, 0.7 0.7, 0 1, -0.7 0.7, -1 0, -0.7 -0.7, 0 -1, 0.7 -0.7"},
                      {"features.path", "circle"},
                      {"scenario.poses", "30"},
                      {"noise.odometry", "1"},
                      {"noise.walk", "0.01"},
                      {"noise.deformation", "0.01"}},
                     tally);
    CHECK(tally.steps == 2 * 29);
    CHECK(tally.dearer == 0);
}

TEST_CASE("planner: no control costs more than the least, on 1,500 random hard scenarios") { check_random(1500); }

TEST_CASE("planner: by every criterion no control costs more than the least, on 300 random hard scenarios") {
    for (const Settings& criterion : criteria()) check_random(300, with_poses(criterion, "4"));
}

TEST_CASE("planner: by every criterion that is no trace the control is the plain form's") {
    for (const Settings& criterion : without_trace)
        check_same(hard_scenarios(40), many != nullptr ? with_poses(criterion, "4") : criterion);
}

TEST_CASE("planner: by every criterion that is no trace, two and three steps ahead, the control is brute force's") {
    for (const Settings& criterion : without_trace)
        for (const char* steps : {"2", "3"}) {
            Settings ahead = with_poses(criterion, "5");
            ahead.insert(ahead.end(), {{"arms.controllers", "horizon"}, {"planner.horizon", steps},
                                       {"planner.speeds", "1"}});
            check_same(hard_scenarios(20) / 10, ahead);
            check_lanes(hard_scenarios(20) / 10, ahead);
        }
}

TEST_CASE("planner: in lanes the same bits as one trial at a time, by every criterion, on random hard scenarios") {
    check_lanes(hard_scenarios(60), {{"arms.controllers", "greedy"}});
    for (Settings criterion : criteria()) {
        criterion.push_back({"arms.controllers", "greedy"});
        check_lanes(hard_scenarios(20), criterion);
    }
}

}  // namespace credence::test::planner_hard_long_test
