#pragma once
// Trials in which the choice of a planner is compared, at every step, with that of a plain form.

#include "slam/trial/trial.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace credence::test {

/// Whether several candidates are within the tie rule's measure of the least cost.
class Ties {
public:
    void offer(double cost) {
        within_ = cost < least_ * (1 - 1e-12) ? 1 : within_ + (cost <= least_ * (1 + 1e-12));
        least_ = std::min(least_, cost);
    }
    bool any() const { return within_ > 1; }

private:
    double least_ = std::numeric_limits<double>::infinity();
    int within_ = 0;
};

struct ChoiceTally {
    std::int64_t choices = 0, different = 0, ties = 0;
};

/// Observes trials. `plain(k, layout, belief, ties)` is the plain form: it returns the command that it chooses, and
/// offers the costs of its candidates to `ties`.
template <class Plain>
class ChoiceComparison {
public:
    ChoiceTally tally;

    explicit ChoiceComparison(const Plain& plain) : plain_(plain) {}

    template <class... Anything>
    void started(const Anything&...) {}
    template <class... Anything>
    void updated(const Anything&...) {}

    template <class Layout, class Belief>
    void planned(int k, const Layout& layout, const Belief& belief) {
        Ties ties;
        chosen_ = plain_(k, layout, belief, ties);
        tally.ties += ties.any();
        ++tally.choices;
    }

    template <class Layout, class Truth, class... More>
    void predicted(int, const Layout&, const Truth&, const Command<double>& command, const More&...) {
        tally.different +=
            command.turn != chosen_.turn || command.move.x != chosen_.move.x || command.move.y != chosen_.move.y;
    }

private:
    const Plain& plain_;
    Command<double> chosen_;
};

template <class Layout, class Observer>
void observe_trials(const ProblemView& view, Controller controller, std::uint64_t seed, int trials,
                    Observer& observer) {
    const auto work = std::make_unique<Workspace<Layout, double>>();
    std::vector<double> columns(column_count);
    std::vector<double> figures(static_cast<std::size_t>(view.series_count * (view.poses - 1)));
    for (int trial = 0; trial < trials; ++trial) {
        const KeyedDraws<double> draws(seed, static_cast<std::uint64_t>(trial), view.world.truncate);
        run_trial(view, controller, draws, observer, *work, columns.data(), figures.data());
    }
}

/// The choices of `controller` beside those of `plain`.
template <class Plain>
ChoiceTally compare_choices(const ProblemView& view, Controller controller, std::uint64_t seed, int trials,
                            const Plain& plain) {
    ChoiceComparison<Plain> comparison(plain);
    const bool three = view.features == 3;
    if (view.process == Process::heading)
        three ? observe_trials<Layout<Process::heading, 3>>(view, controller, seed, trials, comparison)
              : observe_trials<Layout<Process::heading, any_count>>(view, controller, seed, trials, comparison);
    else
        three ? observe_trials<Layout<Process::translation, 3>>(view, controller, seed, trials, comparison)
              : observe_trials<Layout<Process::translation, any_count>>(view, controller, seed, trials, comparison);
    return comparison.tally;
}

}  // namespace credence::test
