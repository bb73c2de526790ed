// The planner's fast forms choose as the plain form does, and the plain form as the oracle (controller_test).

#include "catch.hpp"
#include "choice_comparison.hpp"
#include "filter_samples.hpp"

#include <memory>

namespace credence::test::planner_long_test {

namespace {

/// Compares the choices of greedy trials with those of the direct form, until so many candidates were compared.
ChoiceTally compared(const Settings& settings, std::int64_t candidates) {
    const Problem problem(scenario_with(settings));
    const ProblemView& view = problem.view();
    const std::int64_t per_trial = std::int64_t{view.control.candidate_count} * (view.poses - 1);
    const int trials = static_cast<int>(candidates / per_trial) + 1;
    const auto plain = [&]<class Belief>(int k, const auto& layout, const Belief& belief, Ties& ties) {
        const auto base = std::make_unique<Belief>(), next = std::make_unique<Belief>();
        return plan_plainly(belief, view.control, view.filter, view.sensor, layout, k, *base, *next,
                            [&](int, double cost) { ties.offer(cost); }).command;
    };
    const ChoiceTally tally = compare_choices(view, Controller::greedy, 7, trials, plain);
    CHECK(tally.choices * view.control.candidate_count >= candidates);
    return tally;
}

/// The kinds of planning: process, noise, heading noise, number of features and edge graph.
std::vector<Settings> kinds() {
    std::vector<Settings> all;
    for (const char* noise : {"constant", "ranged"}) {
        for (const char* heading : {"0.001", "0.01", "0.05", "0.1"})
            for (const char* path : {"straight", "circle"})
                all.push_back({{"features.path", path}, {"sensor.noise", noise}, {"noise.heading", heading}});
        all.push_back({{"model.process", "translation"}, {"features.path", "circle"}, {"sensor.noise", noise}});
        for (const char* process : {"heading", "translation"}) {
            const Settings circle{{"model.process", process}, {"features.path", "circle"}, {"sensor.noise", noise}};
            const auto with = [&](Settings more) {
                more.insert(more.begin(), circle.begin(), circle.end());
                all.push_back(more);
            };
            with({{"features.positions", "1 1"}});
            // More than a chunk in translation.
            with({{"features.positions", "1 1, 0.2 0.4, -0.5 1"}, {"planner.speeds", "7"}});
            with({{"features.positions", "1 1, 0 1"}, {"edges.graph", "none"}});
            with({{"features.positions", "0.5 0.5, 0.9 0.8, 0.3 0.4, -1 0, 0 -1, 1 -1"}, {"edges.graph", "chain"}});
            with({{"features.positions", "0 1, 1 0, 0 -1, -1 0, 1 1, -1 1, 1 -1, 2 0"},
                  {"filter.edges", "0.5"},
                  {"planner.speeds", "7"}});
        }
    }
    all.push_back({{"sensor.noise", "ranged"}, {"sensor.sigma_near", "0.05"}, {"sensor.sigma_far", "0.05"}});
    all.push_back({{"sensor.noise", "ranged"}, {"sensor.range_min", "0"}, {"filter.measurement", "0.3"}});
    return all;
}

void check_choices(std::int64_t candidates) {
    for (const Settings& kind : kinds()) {
        CAPTURE(described(kind));
        CHECK(compared(kind, candidates).different == 0);
    }
}

}  // namespace

TEST_CASE("planner: every fast form chooses as the plain form, on 20,000 candidates of each kind") {
    check_choices(20000);
}

TEST_CASE("planner: every fast form chooses as the plain form, on 200,000 candidates of each kind", "[long]") {
    check_choices(200000);
}

TEST_CASE("planner: ties are decided alike") {
    // Standing still is one move on six rays; in the translation model with constant noise all that see the same tie.
    for (const Settings& kind :
         {Settings{{"features.path", "static"},
                   {"sensor.noise", "ranged"},
                   {"features.step", "1"},
                   {"features.positions", "0.5 0, -0.5 0, 0 0.5, 0 -0.5"}},
          {{"model.process", "translation"}, {"features.path", "circle"}},
          {{"model.process", "translation"}, {"features.path", "circle"}, {"planner.speeds", "8"}}}) {
        const ChoiceTally tally = compared(kind, 50000);
        CAPTURE(described(kind));
        CHECK(tally.ties > tally.choices / 20);
        CHECK(tally.different == 0);
    }
}

}  // namespace credence::test::planner_long_test
