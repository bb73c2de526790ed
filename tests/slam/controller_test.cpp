// Who steers [docs/model.md, Controllers].

#include "catch.hpp"
#include "filter_samples.hpp"

namespace credence::test::controller_test {

namespace {

double apart(const Control& a, const Control& b) {
    return std::abs(a.turn - b.turn) + std::hypot(a.move.x - b.move.x, a.move.y - b.move.y);
}

/// Every process, path and grid that the keys allow.
std::vector<Settings> steerings() {
    std::vector<Settings> all;
    for (const char* process : {"heading", "translation"})
        for (const char* features : {"straight", "circle", "static"})
            for (const char* robot : {"as-features", "straight", "circle"})
                for (const char* speeds : {"default", "3"})
                    all.push_back({{"model.process", process}, {"features.path", features}, {"control.path", robot},
                                   {"planner.speeds", speeds}, {"features.step", "1.7"}, {"features.turn", "0.2"}});
    for (const char* path : {"straight", "circle"})
        all.push_back({{"features.path", path}, {"planner.turns", "-0.5, 0.25"}});
    return all;
}

/// Offers costs one after the other; the candidates are their numbers. Gives the number of the choice.
int chosen(const std::vector<double>& costs) {
    Choice<double> choice;
    choice.command.turn = -1;
    for (std::size_t i = 0; i < costs.size(); ++i) {
        const double number = static_cast<double>(i);
        choice.offer({number, {10 * number, -number}}, costs[i]);
    }
    CHECK(choice.command.move.x == (choice.command.turn < 0 ? 0 : 10 * choice.command.turn));
    CHECK(choice.command.move.y == (choice.command.turn < 0 ? 0 : -choice.command.turn));
    return static_cast<int>(choice.command.turn);
}

}  // namespace

TEST_CASE("controller: the planner's candidates are the oracle's, in its order") {
    for (const Settings& settings : steerings()) {
        CAPTURE(described(settings));
        const DeformableSettings scenario = scenario_with(settings);
        const std::vector<Control> ours = planner_candidates(scenario), theirs = oracle::candidates(scenario);
        REQUIRE(ours.size() == theirs.size());
        // Two sines and cosines of lengths of at most 4.
        for (std::size_t i = 0; i < ours.size(); ++i) CHECK(apart(ours[i], theirs[i]) < 4e-15);
    }
}

TEST_CASE("controller: the reference study's candidates are those of the table") {
    const auto list = [](const char* process, const char* path) {
        return planner_candidates(scenario_with({{"model.process", process}, {"features.path", path}}));
    };
    CHECK(list("translation", "straight").size() == 11);
    CHECK(list("translation", "circle").size() == 121);
    CHECK(list("heading", "straight").size() == 21);
    CHECK(list("heading", "circle").size() == 126);
    CHECK(apart(list("translation", "straight").front(), {0, {-2, 0}}) == 0);
    CHECK(apart(list("translation", "straight").back(), {0, {2, 0}}) == 0);
    CHECK(apart(list("translation", "circle")[1], {0, {-2, -1.6}}) < 1e-15);  // a outer, b inner; 0.8 d rounds
    CHECK(apart(list("translation", "circle")[11], {0, {-1.6, -2}}) < 1e-15);
    CHECK(apart(list("heading", "straight").front(), {0, {-4, 0}}) == 0);
    CHECK(apart(list("heading", "straight")[15], {0, {2, 0}}) == 0);
    const double half = std::sqrt(0.5);  // turns outer, from -pi/4 on; s inner, from -2 d on
    CHECK(apart(list("heading", "circle").front(), {-M_PI / 4, {-4 * half, 4 * half}}) < 4e-15);
    CHECK(apart(list("heading", "circle")[20], {-M_PI / 4, {4 * half, -4 * half}}) < 4e-15);
    CHECK(apart(list("heading", "circle").back(), {M_PI / 4, {4 * half, 4 * half}}) < 4e-15);
}

TEST_CASE("controller: fixed controls are the oracle's") {
    for (const Settings& settings : steerings()) {
        CAPTURE(described(settings));
        const DeformableSettings scenario = scenario_with(settings);
        const std::vector<Control> ours = fixed_controls(scenario);
        REQUIRE(ours.size() == 19);
        for (int k = 0; k < 19; ++k)
            CHECK(apart(ours[static_cast<std::size_t>(k)], oracle::fixed_control(scenario, k)) < 4e-15);
    }
}

TEST_CASE("controller: both processes lead the robot of the circle along the same path") {
    // The heading model turns by delta after each step of d (cos delta, sin delta) in its body: one turn ahead of the
    // features in each step but by half a turn's phase; without noise, in the world frame.
    const DeformableSettings heading = scenario_with({{"features.path", "circle"}});
    const DeformableSettings translation =
        scenario_with({{"features.path", "circle"}, {"model.process", "translation"}});
    const Run turning = run_arm(heading, Controller::fixed, silent_noise());
    const Run sliding = run_arm(translation, Controller::fixed, silent_noise());
    const double delta = heading.features.turn;
    for (int k = 1; k < 20; ++k) {
        const auto step = [&](const Run& run, int at) {
            const auto& steps = run.steps;
            const std::size_t now = static_cast<std::size_t>(k);
            return Eigen::Vector2d(steps[now].truth.segment<2>(at) - steps[now - 1].truth.segment<2>(at));
        };
        const double body = (k - 1) * delta + delta, world = delta / 2 + (k - 1) * delta + delta;
        // Rounding of positions below 10 and of 19 headings.
        CHECK((step(turning, 1) - 2 * Eigen::Vector2d(std::cos(body), std::sin(body))).norm() < 1e-13);
        CHECK((step(sliding, 0) - 2 * Eigen::Vector2d(std::cos(world), std::sin(world))).norm() < 1e-13);
    }
}

TEST_CASE("controller: the cost of a candidate is the oracle's brute force") {
    for (const Settings& more : {Settings{}, {{"sensor.noise", "ranged"}, {"filter.measurement", "0.8"}},
                                 {{"edges.graph", "chain"}, {"filter.edges", "2"}, {"noise.heading", "0.3"}},
                                 {{"edges.graph", "none"}, {"sensor.range_max", "1"}, {"filter.covariance", "9"}}})
        with_both(more, [](const Problem& problem, const Sample& sample, auto layout) {
            using Layout = decltype(layout);
            const ProblemView& view = problem.view();
            const auto belief = belief_of<Layout>(sample.x, sample.P);
            Belief<double, Layout::capacity> base, next;
            prepare_candidates(belief, view.filter, layout, 2, base);
            for (int i = 0; i < view.control.candidate_count; i += 7) {
                const Control& control = view.control.candidates[i];
                const double cost = candidate_cost(base, command_from<double>(control), view.control, view.filter,
                                                   view.sensor, layout, next);
                // cond(S) is below 1e4: 12 rows * 1e4 * 2^-53 = 1.3e-11 of the trace before, at most some times the
                // cost.
                CHECK(relative(cost, oracle::candidate_cost(problem.scenario(), {sample.x, sample.P}, control, 2)) <
                      1e-10);
            }
        });
}

TEST_CASE("controller: the planner believes that what is in range will be detected") {
    const DeformableSettings all = scenario_with({}), some = scenario_with({{"sensor.detection", "0.2"}});
    const Run sure = run_arm(all, Controller::greedy, keyed_noise(all, 1, 1));
    const Run unsure = run_arm(some, Controller::greedy, keyed_noise(some, 1, 1));
    CHECK(sure.steps[1].candidate_cost == unsure.steps[1].candidate_cost);
    CHECK(sure.columns[column_unseen] < unsure.columns[column_unseen]);
}

TEST_CASE("controller: every candidate's cost is reported, in order, and the choice is made from them") {
    const DeformableSettings scenario = scenario_with({{"features.path", "circle"}});
    const Run run = run_arm(scenario, Controller::greedy, keyed_noise(scenario, 4, 1));
    const std::vector<Control> candidates = planner_candidates(scenario);
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        REQUIRE(run.steps[k].candidate_cost.size() == candidates.size());
        CHECK(run.steps[k].control == candidates[static_cast<std::size_t>(chosen(run.steps[k].candidate_cost))]);
    }
}

TEST_CASE("controller: chosen controls are the oracle's in all cells") {
    for (const Settings& cell : seed_cells())
        for (std::uint64_t trial = 100; trial < 115; ++trial) {
            const DeformableSettings scenario = scenario_with(cell);
            const AnyNoise noise = keyed_noise(scenario, 5, trial);
            const Run ours = run_arm(scenario, Controller::greedy, noise);
            const Difference worst = difference(ours, oracle::run(scenario, Controller::greedy, for_oracle(noise)));
            CAPTURE(described(cell), trial);
            CHECK(worst.same_control);
            CHECK(worst.cost < 1e-10);  // as above
        }
}

TEST_CASE("controller: the least cost wins, and the later of equals") {
    CHECK(chosen({3, 1, 2}) == 1);
    CHECK(chosen({1, 1, 1}) == 2);
    CHECK(chosen({2, 1, 1, 2}) == 2);
    CHECK(chosen({infinity, infinity}) == 1);
    CHECK(chosen({5}) == 0);
}

TEST_CASE("controller: equal means within 1e-12 of the least cost so far") {
    CHECK(chosen({1, 1 + 0.9e-12}) == 1);
    CHECK(chosen({1, 1 + 1.1e-12}) == 0);
    CHECK(chosen({1, 1 - 1e-15}) == 1);
    // The least cost stays the measure: a chain of equals may not creep upwards.
    CHECK(chosen({1, 1 + 0.9e-12, 1 + 1.8e-12}) == 1);
    CHECK(chosen({1, 1 + 0.9e-12, 1 + 0.5e-12}) == 2);
    CHECK(chosen({1e-3, 1e-3 * (1 + 0.9e-12)}) == 1);
}

TEST_CASE("controller: a cost that is no number is never chosen") {
    CHECK(chosen({not_a_number, 2, not_a_number}) == 1);
    CHECK(chosen({not_a_number, not_a_number}) == -1);
}

TEST_CASE("controller: standing still ties on all rays, and the last ray wins") {
    // Features that surround a robot at rest; every s = 0 is the same move, and the turn has no cost.
    const DeformableSettings scenario = scenario_with({{"features.path", "static"},
                                                       {"features.positions", "0.5 0, -0.5 0, 0 0.5, 0 -0.5"},
                                                       {"sensor.noise", "ranged"},
                                                       {"features.step", "1"}});
    const Run run = run_arm(scenario, Controller::greedy, silent_noise());
    CHECK(run.steps[1].control == Control{*scenario.planner.turns->rbegin(), {0, 0}});
    for (int ray = 0; ray < 6; ++ray)  // equal but for the rounding of a trace
        CHECK(relative(run.steps[1].candidate_cost[static_cast<std::size_t>(21 * ray + 10)],
                       run.steps[1].candidate_cost[10]) < 1e-13);
}

}  // namespace credence::test::controller_test
