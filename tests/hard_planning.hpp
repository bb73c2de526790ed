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

/// Compares, at every step of a pack of planned trials, what the chosen control costs with the least cost: over as many
/// steps as the controller plans ahead, by brute force of controller.hpp's plain ones.
template <class Real>
class Comparison {
public:
    Comparison(const ProblemView& view, Controller controller, Tally& tally)
        : view_(view), controller_(controller), tally_(tally) {}

    void started(const auto&...) {}
    void updated(const auto&...) {}

    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        costs_.clear();
        choice_ = no_choice<Real>(view_.control);
        each_sum(belief, layout, k, view_.steps_ahead(controller_, k), [&](const Command<Real>& command, Real sum) {
            costs_.push_back(sum);
            choice_.offer(command, sum);
        });
    }

    void predicted(int, const auto&, const auto&, const Command<Real>& command, const auto&...) {
        const bool logarithm = scale_of(view_.control.criterion) == CostScale::logarithmic;
        for (int lane = 0; lane < lanes<Real>; ++lane) {
            double least = infinity, taken = infinity;
            for (std::size_t i = 0; i < costs_.size(); ++i) {
                const Control& candidate = view_.control.candidates[i];
                const double cost = lane_of(costs_[i], lane);
                least = std::min(least, cost);
                if (candidate.turn == lane_of(command.turn, lane) &&
                    candidate.move.x == lane_of(command.move.x, lane) &&
                    candidate.move.y == lane_of(command.move.y, lane))
                    taken = cost;
            }
            ++tally_.steps;
            tally_.planned += !costs_.empty();
            const auto differs = [&](const Real& a, const Real& b) { return lane_of(a, lane) != lane_of(b, lane); };
            const bool different = least < infinity && (differs(choice_.command.turn, command.turn) ||
                                                        differs(choice_.command.move.x, command.move.x) ||
                                                        differs(choice_.command.move.y, command.move.y));
            const auto beyond = [&](double share) { return taken - least > share * (logarithm ? 1 : std::abs(least)); };
            tally_.different += different;
            tally_.tied += different && !beyond(1e-12);
            tally_.dearer += least < infinity && beyond(1e-9);
        }
    }

private:
    template <class Layout, class Belief>
    void each_sum(const Belief& belief, const Layout& layout, int k, int steps,
                  const std::function<void(const Command<Real>&, Real)>& visit) {
        const auto base = std::make_unique<Belief>(), next = std::make_unique<Belief>();
        prepare_candidates(belief, view_.filter, layout, k, *base);
        for (int i = 0; i < view_.control.candidate_count; ++i) {
            const Command<Real> command = command_from<Real>(view_.control.candidates[i]);
            Real sum = candidate_cost(*base, command, view_.control, view_.filter, view_.sensor, layout, *next);
            if (steps > 1) {
                Real least = without_limit<Real>();
                each_sum(*next, layout, k + 1, steps - 1,
                         [&](const Command<Real>&, Real rest) { least = smaller(rest, least); });
                sum = sum + least;
            }
            visit(command, sum);
        }
    }

    const ProblemView& view_;
    Controller controller_;
    Tally& tally_;
    std::vector<Real> costs_;
    Choice<Real> choice_;
};

/// One pack of trials.
template <class Layout, class Real>
void run_pack(const Problem& problem, Controller controller, Tally& tally) {
    const ProblemView& view = problem.view();
    const auto work = std::make_unique<Workspace<Layout, Real>>();
    std::vector<Real> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
    Real columns[column_count];
    Comparison<Real> comparison(view, controller, tally);
    const KeyedDraws<Real> draws(1, trials_from<Real>(0), view.world.truncate);
    run_trial(view, controller, draws, comparison, *work, columns, figures.data());
}

/// (Not each layout in each width, because each takes long to compile.)
template <Process process, class Real>
void run_layout(const Problem& problem, Controller controller, Tally& tally) {
    if constexpr (lanes<Real> == 1)
        if (problem.view().features == 1) return run_pack<Layout<process, 1>, Real>(problem, controller, tally);
    if constexpr (lanes<Real> == 1 || lanes<Real> == 8)
        if (problem.view().features == 3) return run_pack<Layout<process, 3>, Real>(problem, controller, tally);
    run_pack<Layout<process, any_count>, Real>(problem, controller, tally);
}

template <class Real>
void run_scenario(const Settings& settings, Tally& tally) {
    const Problem problem(scenario_with(settings));
    const auto& arms = problem.scenario().arms.controllers;
    const Controller controller = arms == std::vector{Controller::horizon} ? Controller::horizon : Controller::greedy;
    ++tally.scenarios;
    if (problem.view().process == Process::heading)
        run_layout<Process::heading, Real>(problem, controller, tally);
    else
        run_layout<Process::translation, Real>(problem, controller, tally);
}

/// Runs so many random scenarios with further settings. Scenarios that contradict themselves are passed over: about one
/// in seven.
template <class Real>
Tally run_random(unsigned count, const Settings& more = {}) {
    Tally tally;
    for (unsigned seed = 0; seed < count; ++seed) {
        Settings settings = Lottery(seed).settings();
        settings.insert(settings.end(), more.begin(), more.end());
        try {
            run_scenario<Real>(settings, tally);
        } catch (const InputError&) {
        }
    }
    return tally;
}

}  // namespace credence::test
