// Planning several steps ahead: as the oracle's brute force, and as a brute force of plain steps.

#include "catch.hpp"
#include "choice_comparison.hpp"
#include "support.hpp"

#include "worlds/deformable/deformable.hpp"
#include "slam_steps.hpp"
#include "slam/trial/trial.hpp"

#include <algorithm>
#include <memory>

namespace credence::test::horizon_long_test {

namespace {

Settings with(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

/// A scenario whose arms plan ahead.
DeformableSettings planning(const Settings& settings) {
    return scenario_with(with(settings, {{"arms.controllers", "greedy, horizon"}}));
}

/// Both processes, paths and noises, with few candidates.
std::vector<Settings> small_kinds() {
    std::vector<Settings> kinds;
    for (Settings& cell : seed_cells()) kinds.push_back(with(cell, {{"planner.speeds", "1"}, {"scenario.poses", "6"}}));
    for (Settings& kind : kinds)
        if (kind[0].second == "heading" && kind[1].second == "circle") kind.push_back({"planner.turns", "-0.4, 0.3"});
    return kinds;
}

/// The least sum of trace(P) over `steps` steps by brute force of controller.hpp's plain ones.
template <class Layout, class Belief>
double plain_cost(const ProblemView& view, const Layout& layout, const Belief& belief, int candidate, int k,
                  int steps) {
    const auto base = std::make_unique<Belief>(), next = std::make_unique<Belief>();
    prepare_candidates(belief, view.filter, layout, k, *base);
    const double cost = candidate_cost(*base, command_from<double>(view.control.candidates[candidate]), view.control,
                                       view.filter, view.sensor, layout, *next);
    if (steps == 1) return cost;
    double least = infinity;
    for (int i = 0; i < view.control.candidate_count; ++i)
        least = std::min(least, plain_cost(view, layout, *next, i, k + 1, steps - 1));
    return cost + least;
}

/// Compares what trials that plan ahead choose with what brute force chooses.
ChoiceTally compared(const Settings& settings, int trials) {
    const Problem problem(planning(settings));
    const ProblemView& view = problem.view();
    const auto plain = [&](int k, const auto& layout, const auto& belief, Ties& ties) {
        const int steps = view.steps_ahead(Controller::horizon, k);
        Choice<double> choice;
        for (int i = 0; i < view.control.candidate_count; ++i) {
            const double cost = plain_cost(view, layout, belief, i, k, steps);
            ties.offer(cost);
            choice.offer(command_from<double>(view.control.candidates[i]), cost);
        }
        return choice.command;
    };
    return compare_choices(view, Controller::horizon, 9, trials, plain);
}

std::vector<std::vector<double>> all_figures(const Run& run) {
    std::vector<std::vector<double>> all{run.columns};
    for (int f = 0; f < run.figures.rows(); ++f) {
        const Eigen::VectorXd row = run.figures.row(f);
        all.emplace_back(row.data(), row.data() + row.size());
    }
    return all;
}

}  // namespace

TEST_CASE("horizon: controls and their costs are the oracle's brute force, two and three steps ahead") {
    for (const Settings& kind : small_kinds())
        for (const char* steps : {"2", "3"})
            for (std::uint64_t trial = 0; trial < 2; ++trial) {
                const DeformableSettings scenario = planning(with(kind, {{"planner.horizon", steps}}));
                const AnyNoise noise = keyed_noise(scenario, 6, trial);
                const Run ours = run_arm(scenario, Controller::horizon, noise);
                const Difference worst =
                    difference(ours, oracle::run(scenario, Controller::horizon, for_oracle(noise)));
                CAPTURE(described(kind), steps, trial);
                CHECK(worst.same_control);
                // cond(S) is below 1e4: up to three updates of 12 rows * 1e4 * 2^-53 = 1.3e-11 of the trace before
                // each.
                CHECK(worst.condition < 1e4);
                CHECK(worst.cost < 1e-10);
            }
}

TEST_CASE("horizon: a horizon of one step is the greedy planner, bit for bit") {
    for (const Settings& cell : seed_cells()) {
        const DeformableSettings scenario = planning(with(cell, {{"planner.horizon", "1"}}));
        const AnyNoise noise = keyed_noise(scenario, 7, 1);
        CAPTURE(described(cell));
        const auto greedy = all_figures(run_arm(scenario, Controller::greedy, noise));
        const auto ahead = all_figures(run_arm(scenario, Controller::horizon, noise));
        for (std::size_t f = 0; f < greedy.size(); ++f) CHECK(same_bits(greedy[f], ahead[f]));
    }
}

TEST_CASE("horizon: every fast form of the last step chooses as brute force of plain steps") {
    const Settings circle{{"features.path", "circle"}, {"scenario.poses", "7"}}, flat{{"model.process", "translation"}},
        ranged{{"sensor.noise", "ranged"}};
    const char* six = "0.5 0.5, 0.9 0.8, 0.3 0.4, -1 0, 0 -1, 1 -1";
    const char* eight = "0 1, 1 0, 0 -1, -1 0, 1 1, -1 1, 1 -1, 2 0";
    const std::vector<Settings> kinds{
        with(circle, {{"planner.speeds", "4"}}),
        with(circle, with(ranged, {{"planner.speeds", "4"}, {"noise.heading", "0.05"}})),
        with(circle, with(ranged, {{"planner.speeds", "12"}, {"scenario.poses", "4"}})),  // 150: more than one chunk
        with(circle, {{"planner.horizon", "3"}, {"planner.speeds", "1"}}),
        with(circle, with(ranged, {{"planner.horizon", "3"}, {"planner.speeds", "1"}, {"noise.heading", "0.1"}})),
        with(circle, with(flat, {{"planner.speeds", "2"}})),
        with(circle, with(flat, with(ranged, {{"planner.speeds", "2"}}))),
        with(circle, with(flat, {{"planner.speeds", "1"}, {"planner.horizon", "3"}})),
        with(circle, {{"planner.speeds", "1"}, {"features.positions", "1 1"}}),
        with(circle, {{"planner.speeds", "1"}, {"features.positions", six}, {"edges.graph", "chain"}}),
        with(circle, with(flat, {{"planner.speeds", "1"}, {"features.positions", eight}, {"filter.edges", "0.5"}})),
        with(flat, {{"planner.horizon", "4"}, {"planner.speeds", "2"}, {"scenario.poses", "6"}}),
        with(ranged, {{"planner.horizon", "3"}, {"filter.measurement", "0.3"}, {"scenario.poses", "5"}})};
    for (const Settings& kind : kinds) {
        CAPTURE(described(kind));
        const ChoiceTally tally = compared(kind, 2);
        CHECK(tally.choices > 0);
        CHECK(tally.different == 0);
    }
}

TEST_CASE("horizon: ties are decided as in the plain rule, the later candidate of equals") {
    // Standing still is one move on six rays, and the last step's turn has no cost; in the translation model with
    // constant noise all sequences that see the same tie.
    const ChoiceTally rays = compared({{"features.path", "static"}, {"sensor.noise", "ranged"}, {"features.step", "1"},
                                      {"planner.speeds", "2"}, {"features.positions", "0.5 0, -0.5 0, 0 0.5, 0 -0.5"},
                                      {"scenario.poses", "6"}}, 6);
    const ChoiceTally sets = compared({{"model.process", "translation"}, {"features.path", "circle"},
                                      {"planner.speeds", "2"}, {"scenario.poses", "6"}}, 20);
    for (const ChoiceTally& tally : {rays, sets}) {
        CHECK(tally.ties > tally.choices / 20);
        CHECK(tally.different == 0);
    }
}

TEST_CASE("horizon: it ends at the last pose") {
    const Settings short_run{{"scenario.poses", "4"}, {"planner.speeds", "1"}};
    const auto costs = [&](const char* steps, std::size_t k) {
        const DeformableSettings scenario = planning(with(short_run, {{"planner.horizon", steps}}));
        return run_arm(scenario, Controller::horizon, keyed_noise(scenario, 3, 2)).steps[k].candidate_cost;
    };
    CHECK(costs("3", 1) == costs("8", 1));  // three steps are left, then two, then one
    CHECK(costs("3", 1) != costs("2", 1));
    const DeformableSettings scenario = planning(with(short_run, {{"planner.horizon", "8"}}));
    const Run run = run_arm(scenario, Controller::horizon, keyed_noise(scenario, 3, 2));
    CHECK(relative(run.steps[3].candidate_cost[0],
                   oracle::candidate_cost(scenario, {run.steps[2].mean, run.steps[2].covariance},
                                          planner_candidates(scenario)[0], 3)) < 1e-10);
}

TEST_CASE("horizon: the sum counts, not the next step alone") {
    // At each step the greedy choice has the least next trace, the horizon's the least sum, and somewhere they differ.
    const DeformableSettings scenario = planning({{"model.process", "translation"}, {"features.path", "circle"}});
    const Trajectory trajectory = replay_trial(Problem(scenario), {Controller::horizon, Estimator::kf}, 1, 0);
    const std::vector<TrajectoryStep> steps = steps_of(trajectory);
    const std::vector<Control> candidates = planner_candidates(scenario);
    int differ = 0;
    for (int k = 1; k + 1 < scenario.poses; ++k) {
        const std::size_t at = static_cast<std::size_t>(k);
        const TrajectoryStep &before = steps[at - 1], &step = steps[at];
        Eigen::VectorXd next(static_cast<Eigen::Index>(candidates.size()));
        for (Eigen::Index i = 0; i < next.size(); ++i)
            next[i] = oracle::candidate_cost(scenario, {before.mean, before.covariance},
                                             candidates[static_cast<std::size_t>(i)], k);
        const auto found = std::find(candidates.begin(), candidates.end(), step.control);
        REQUIRE(found != candidates.end());
        const std::size_t chosen = static_cast<std::size_t>(found - candidates.begin()),
                          greedy = static_cast<std::size_t>(oracle::greedy_choice(scenario, next));
        const double of_chosen = next[static_cast<Eigen::Index>(chosen)],
                     of_greedy = next[static_cast<Eigen::Index>(greedy)];
        CHECK(of_greedy <= of_chosen * (1 + 1e-12));
        CHECK(step.candidate_cost[chosen] <= step.candidate_cost[greedy] * (1 + 1e-12));
        differ += step.candidate_cost[chosen] < step.candidate_cost[greedy] * 0.999;
    }
    CHECK(differ > 0);
}

TEST_CASE("horizon: a limit leaves exact what lies below it") {
    for (const Settings& kind : small_kinds()) {
        const Problem problem(planning(kind));
        const ProblemView& view = problem.view();
        const auto check = [&](auto layout) {
            using Layout = decltype(layout);
            const auto work = std::make_unique<Workspace<Layout, double>>();
            const Run run = run_arm(problem.scenario(), Controller::fixed, keyed_noise(problem.scenario(), 5, 3));
            Belief<double, Layout::capacity> belief{};
            for (int i = 0; i < layout.size(); ++i) {
                belief.mean[i] = run.steps[3].mean[i];
                for (int j = i; j < layout.size(); ++j) belief.covariance.entry[i][j] = run.steps[3].covariance(i, j);
            }
            const Planning<Layout, double> given{view.control, view.filter, view.sensor, layout, work->planner};
            const auto least = [&](double limit) {
                return least_sum(given, belief, 4, 2, work->horizon.ahead, limit);
            };
            const double exact = least(infinity);
            CAPTURE(described(kind), exact);
            CHECK(same_bits(least(exact), exact));
            CHECK(same_bits(least(exact * 1.5), exact));
            CHECK(least(exact * 0.999) >= exact);
            CHECK(least(exact * 0.5) >= exact);
        };
        if (view.process == Process::heading) check(Layout<Process::heading, 3>(3));
        else check(Layout<Process::translation, 3>(3));
    }
}

TEST_CASE("horizon: in lanes the same bits as one trial at a time, on any target") {
    for (const Settings& kind : small_kinds()) {
        CAPTURE(described(kind));
        const char* const steps = kind[1].second == "circle" ? "2" : "3";
        const Problem problem(planning(with(kind, {{"planner.horizon", steps}})));
        CHECK(other_bits_in_lanes(problem) == std::vector<std::string>{});
    }
}

}  // namespace credence::test::horizon_long_test
