// The planner's fast forms choose as the plain form does, and the plain form as the oracle (controller_test).

#include "catch.hpp"
#include "filter_samples.hpp"

#include "slam/trial/trial.hpp"

#include <memory>

using namespace credence;
using namespace credence::test;

namespace {

/// The choices of one planner, step by step, beside the direct form.
struct Tally {
    std::int64_t candidates = 0, choices = 0, different = 0, ties = 0;
};

/// Compares, at every step of a greedy trial, the choice with that of the direct form.
class Comparison {
public:
    Comparison(const ProblemView& view, Tally& tally) : view_(view), tally_(tally) {}

    template <class... Anything>
    void started(const Anything&...) {}
    template <class... Anything>
    void updated(const Anything&...) {}

    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        const auto base = std::make_unique<Belief>(), next = std::make_unique<Belief>();
        double best = infinity;
        int within = 0;  // candidates within the tie rule's measure of the least cost so far
        plain_ = plan_plainly(belief, view_.control, view_.filter, view_.sensor, layout, k, *base, *next,
                              [&](int, double cost) {
                                  within = cost < best * (1 - 1e-12) ? 1 : within + (cost <= best * (1 + 1e-12));
                                  best = std::min(best, cost);
                              }).command;
        tally_.candidates += view_.control.candidate_count;
        tally_.ties += within > 1;
        ++tally_.choices;
    }

    template <class Layout, class Truth, class... More>
    void predicted(int, const Layout&, const Truth&, const Command<double>& command, const More&...) {
        tally_.different +=
            command.turn != plain_.turn || command.move.x != plain_.move.x || command.move.y != plain_.move.y;
    }

private:
    const ProblemView& view_;
    Tally& tally_;
    Command<double> plain_;
};

template <class Layout>
void run_trials(const Problem& problem, int trials, Tally& tally) {
    const ProblemView& view = problem.view();
    const auto work = std::make_unique<Workspace<Layout, double>>();
    std::vector<double> columns(column_count);
    std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
    for (int trial = 0; trial < trials; ++trial) {
        Comparison comparison(view, tally);
        const KeyedDraws<double> draws(7, static_cast<std::uint64_t>(trial), view.world.truncate);
        run_trial(view, Controller::greedy, draws, comparison, *work, columns.data(), figures.data());
    }
}

/// Runs trials until so many candidates were compared.
Tally compared(const Settings& settings, std::int64_t candidates) {
    const Problem problem(scenario_with(settings));
    Tally tally;
    const std::int64_t per_trial = std::int64_t{problem.view().control.candidate_count} * (problem.view().poses - 1);
    const int trials = static_cast<int>(candidates / per_trial) + 1;
    const bool three = problem.view().features == 3;
    if (problem.view().process == Process::heading)
        three ? run_trials<Layout<Process::heading, 3>>(problem, trials, tally)
              : run_trials<Layout<Process::heading, any_count>>(problem, trials, tally);
    else
        three ? run_trials<Layout<Process::translation, 3>>(problem, trials, tally)
              : run_trials<Layout<Process::translation, any_count>>(problem, trials, tally);
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
            with({{"features.positions", "1 1, 0.2 0.4, -0.5 1"}, {"planner.speeds", "7"}});  // more than a chunk in translation
            with({{"features.positions", "1 1, 0 1"}, {"edges.graph", "none"}});
            with({{"features.positions", "0.5 0.5, 0.9 0.8, 0.3 0.4, -1 0, 0 -1, 1 -1"}, {"edges.graph", "chain"}});
            with({{"features.positions", "0 1, 1 0, 0 -1, -1 0, 1 1, -1 1, 1 -1, 2 0"}, {"filter.edges", "0.5"}, {"planner.speeds", "7"}});
        }
    }
    all.push_back({{"sensor.noise", "ranged"}, {"sensor.sigma_near", "0.05"}, {"sensor.sigma_far", "0.05"}});
    all.push_back({{"sensor.noise", "ranged"}, {"sensor.range_min", "0"}, {"filter.measurement", "0.3"}});
    return all;
}

void check_choices(std::int64_t candidates) {
    for (const Settings& kind : kinds()) {
        CAPTURE(described(kind));
        const Tally tally = compared(kind, candidates);
        CHECK(tally.different == 0);
        CHECK(tally.candidates >= candidates);
    }
}

}  // namespace

TEST_CASE("planner: every fast form chooses as the plain form, on 20,000 candidates of each kind") { check_choices(20000); }

TEST_CASE("planner: every fast form chooses as the plain form, on 200,000 candidates of each kind", "[long]") {
    check_choices(200000);
}

TEST_CASE("planner: ties are decided alike") {
    // Standing still is one move on six rays; in the translation model with constant noise all that see the same tie.
    for (const Settings& kind : {Settings{{"features.path", "static"}, {"sensor.noise", "ranged"}, {"features.step", "1"},
                                          {"features.positions", "0.5 0, -0.5 0, 0 0.5, 0 -0.5"}},
                                 {{"model.process", "translation"}, {"features.path", "circle"}},
                                 {{"model.process", "translation"}, {"features.path", "circle"}, {"planner.speeds", "8"}}}) {
        const Tally tally = compared(kind, 50000);
        CAPTURE(described(kind));
        CHECK(tally.ties > tally.choices / 20);
        CHECK(tally.different == 0);
    }
}
