#pragma once
// Planning in scenarios drawn at random, many of them badly conditioned, so that fast forms lose most or all of their
// digits: what the planner executes beside the least that the plain form finds.

#include "support.hpp"

#include <credence/error.hpp>
#include "engine/simulate_batch.hpp"
#include "slam/trial/trial.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace credence::test {

/// Draws the settings of a scenario.
class Lottery {
public:
    explicit Lottery(unsigned seed) : random_(seed) {}

    Settings settings() {
        const bool heading = once_in(2), ranged = once_in(2);
        set("model.process", heading ? "heading" : "translation");
        set("sensor.noise", ranged ? "ranged" : "constant");
        draw_features();
        draw_sensor(ranged);
        for (const char* key : {"noise.odometry", "noise.walk", "noise.deformation"})
            if (!once_in(4)) set(key, between(1e-3, 1));
        if (heading && !once_in(4)) set("noise.heading", between(1e-4, 1));
        set("edges.graph", one_of({"all", "all", "chain", "none"}));
        for (const char* key : {"filter.measurement", "filter.edges", "filter.features"})
            if (once_in(3)) set(key, between(0.1, 3));
        if (once_in(3)) draw_extremes(heading);
        if (once_in(3)) set("planner.speeds", std::to_string(1 + number(14)));
        if (heading && once_in(3)) draw_turns();
        set("scenario.poses", std::to_string(3 + number(once_in(6) ? 60 : 18)));
        return settings_;
    }

private:
    unsigned number(unsigned count) { return static_cast<unsigned>(random_() % count); }
    bool once_in(unsigned times) { return number(times) == 0; }
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
    }
    std::string between(double low, double high) { return std::to_string(low * std::pow(high / low, uniform(0, 1))); }
    std::string one_of(const std::vector<const char*>& words) {
        return words[number(static_cast<unsigned>(words.size()))];
    }
    void set(const std::string& key, const std::string& value) { settings_.emplace_back(key, value); }

    void draw_features() {
        const unsigned features = once_in(3) ? 3 : once_in(4) ? 7 + number(6) : 1 + number(8);
        const double spread = std::pow(10, uniform(-1, 1));
        std::string positions;
        for (unsigned j = 0; j < features; ++j)
            positions += (j > 0 ? ", " : "") + std::to_string(uniform(-spread, spread)) + " " +
                         std::to_string(uniform(-spread, spread));
        set("features.positions", positions);
        set("features.path", one_of({"straight", "circle", "circle", "static"}));
        if (once_in(2)) set("features.step", between(0.1, 10));
    }

    void draw_sensor(bool ranged) {
        set("sensor.range_min", one_of({"0", "0.1"}));
        set("sensor.range_max", !ranged && once_in(3) ? "inf" : between(1, 30));
        if (!once_in(4)) set("sensor.sigma", between(1e-3, 1));
        const double near = std::pow(10, uniform(-3, -0.5));
        set("sensor.sigma_near", std::to_string(near));
        set("sensor.sigma_far", std::to_string(near * std::pow(10, uniform(0, 1.5))));
    }

    /// The robot loses itself, the features hardly move: what is left after the sightings is a small difference of
    /// large numbers.
    void draw_extremes(bool heading) {
        set("noise.odometry", between(1, 1e3));
        set("noise.walk", between(1e-4, 0.1));
        set("noise.deformation", between(1e-4, 0.1));
        if (once_in(2)) set("noise.initial_position", between(1, 1e4));
        if (heading && once_in(2)) set("noise.initial_heading", between(0.1, 3));
    }

    void draw_turns() {
        std::string turns;
        for (unsigned i = 0, count = 1 + number(6); i < count; ++i)
            turns += (i > 0 ? ", " : "") + std::to_string(uniform(-3, 3));
        set("planner.turns", turns);
    }

    std::mt19937 random_;
    Settings settings_;
};

/// Steps, and those that were planned; those whose control is not the plain form's, and of these those that cost the
/// least but for rounding, 1e-12 of it; those whose control costs more than the least by more than 1e-9 of it (which
/// rounding may have made negative), or by more than 1e-9 where costs are logarithms. A control that is no candidate
/// costs infinitely much.
struct Tally {
    int scenarios = 0, steps = 0, planned = 0, different = 0, tied = 0, dearer = 0;
};

/// Compares, at every step of a planned trial, what the chosen control costs with the least cost: over as many steps as
/// the controller plans ahead, by brute force of controller.hpp's plain ones.
class Comparison {
public:
    Comparison(const ProblemView& view, Controller controller, Tally& tally)
        : view_(view), controller_(controller), tally_(tally) {}

    void started(const auto&...) {}
    void updated(const auto&...) {}

    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        costs_.clear();
        choice_ = no_choice<double>(view_.control);
        each_sum(belief, layout, k, view_.steps_ahead(controller_, k), [&](const Command<double>& command, double sum) {
            costs_.push_back(sum);
            choice_.offer(command, sum);
        });
    }

    void predicted(int, const auto&, const auto&, const Command<double>& command, const auto&...) {
        const bool logarithm = scale_of(view_.control.criterion) == CostScale::logarithmic;
        const auto chosen = [&](const auto& other) {
            return other.turn == command.turn && other.move.x == command.move.x && other.move.y == command.move.y;
        };
        double least = infinity, taken = infinity;
        for (std::size_t i = 0; i < costs_.size(); ++i) {
            least = std::min(least, costs_[i]);
            if (chosen(view_.control.candidates[i])) taken = costs_[i];
        }
        ++tally_.steps;
        tally_.planned += !costs_.empty();
        const bool different = least < infinity && !chosen(choice_.command);
        const auto beyond = [&](double share) { return taken - least > share * (logarithm ? 1 : std::abs(least)); };
        tally_.different += different;
        tally_.tied += different && !beyond(1e-12);
        tally_.dearer += least < infinity && beyond(1e-9);
    }

private:
    template <class Layout, class Belief>
    void each_sum(const Belief& belief, const Layout& layout, int k, int steps,
                  const std::function<void(const Command<double>&, double)>& visit) {
        const auto base = std::make_unique<Belief>(), next = std::make_unique<Belief>();
        prepare_candidates(belief, view_.filter, layout, k, *base);
        for (int i = 0; i < view_.control.candidate_count; ++i) {
            const Command<double> command = command_from<double>(view_.control.candidates[i]);
            double sum = candidate_cost(*base, command, view_.control, view_.filter, view_.sensor, layout, *next);
            if (steps > 1) {
                double least = without_limit<double>();
                each_sum(*next, layout, k + 1, steps - 1,
                         [&](const Command<double>&, double rest) { least = smaller(rest, least); });
                sum += least;
            }
            visit(command, sum);
        }
    }

    const ProblemView& view_;
    Controller controller_;
    Tally& tally_;
    std::vector<double> costs_;
    Choice<double> choice_;
};

template <class Layout>
void run_layout(const Problem& problem, Controller controller, Tally& tally) {
    const ProblemView& view = problem.view();
    const auto work = std::make_unique<Workspace<Layout, double>>();
    std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
    double columns[column_count];
    Comparison comparison(view, controller, tally);
    const KeyedDraws<double> draws(1, trials_from<double>(0), view.world.truncate);
    run_trial(view, controller, draws, comparison, *work, columns, figures.data());
}

template <Process process>
void run_process(const Problem& problem, Controller controller, Tally& tally) {
    if (problem.view().features == 1) return run_layout<Layout<process, 1>>(problem, controller, tally);
    if (problem.view().features == 3) return run_layout<Layout<process, 3>>(problem, controller, tally);
    run_layout<Layout<process, any_count>>(problem, controller, tally);
}

inline void run_scenario(const Settings& settings, Tally& tally) {
    const Problem problem(scenario_with(settings));
    const auto& arms = problem.scenario().arms.controllers;
    const Controller controller = arms == std::vector{Controller::horizon} ? Controller::horizon : Controller::greedy;
    ++tally.scenarios;
    if (problem.view().process == Process::heading) run_process<Process::heading>(problem, controller, tally);
    else run_process<Process::translation>(problem, controller, tally);
}

/// Calls `run` with the settings of so many random scenarios and further ones. Scenarios that contradict themselves are
/// passed over: about one in seven.
inline void each_random(unsigned count, const Settings& more, const std::function<void(const Settings&)>& run) {
    for (unsigned seed = 0; seed < count; ++seed) {
        Settings settings = Lottery(seed).settings();
        settings.insert(settings.end(), more.begin(), more.end());
        try {
            run(settings);
        } catch (const InputError&) {
        }
    }
}

inline Tally run_random(unsigned count, const Settings& more = {}) {
    Tally tally;
    each_random(count, more, [&](const Settings& settings) { run_scenario(settings, tally); });
    return tally;
}

}  // namespace credence::test
