#pragma once
// Planning over several steps with a receding horizon [docs/model.md, Controllers: horizon]. It finds the sequence of
// candidates over the horizon whose sum of costs is least and takes its first control; at the next pose it plans
// again. Planning uses no measurements: each step starts from the mean and the covariance that the greedy planner's
// model expects after the step before.

#include "slam/planning/planner.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The beliefs along a sequence, before the robot moves: one for each step but the last, and workspace for the next
/// one.
template <class Layout, class Real>
struct HorizonWorkspace {
    Belief<Real, Layout::capacity> ahead[largest_horizon];
};

template <class Layout, class Real, int capacity>
Real least_sum(const Planning<Layout, Real>& given, const Belief<Real, capacity>& belief, int k, int steps,
               Belief<Real, capacity>* ahead, Real limit);

/// Computes, for each candidate as the first of `steps` > 1 steps, the least sum of costs over these, and calls
/// visit(i, command, sum). `belief` is that of pose k - 1, and may be ahead[0]; `limit()` is as for least_sum. Where
/// costs are positive, and the first step's reaches the limit in all lanes, so does the sum, and visit is not called.
template <class Layout, class Real, int capacity, class Limit, class Visit>
void look_ahead(const Planning<Layout, Real>& given, const Belief<Real, capacity>& belief, int k, int steps,
                Belief<Real, capacity>* ahead, const Limit& limit, Visit&& visit) {
    const auto& [control, filter, sensor, layout, work] = given;
    const bool positive = scale_of(control.criterion) == CostScale::linear;
    prepare_candidates(belief, filter, layout, k, ahead[0]);
    for (int i = 0; i < control.candidate_count; ++i) {
        const Command<Real> command = command_from<Real>(control.candidates[i]);
        const Real next = candidate_cost(ahead[0], command, control, filter, sensor, layout, ahead[1]);
        // The margin covers the rounding of sums and the tolerance of the tie rule.
        const Real rest = (positive ? limit() * Real(1 + 1e-9) : limit() + Real(1e-9)) - next;
        if (!positive || any(negated(rest <= Real(0))))
            visit(i, command, next + least_sum(given, ahead[1], k + 1, steps - 1, ahead + 1, rest));
    }
}

/// The least sum of costs over `steps` steps from the belief at pose k - 1. Sums up to `limit` are exact; above it,
/// only that they are above it is certain.
template <class Layout, class Real, int capacity>
Real least_sum(const Planning<Layout, Real>& given, const Belief<Real, capacity>& belief, int k, int steps,
               Belief<Real, capacity>* ahead, Real limit) {
    if (steps == 1) return choose(belief, given, k, limit).best;
    Real least = without_limit<Real>();
    look_ahead(given, belief, k, steps, ahead, [&] { return smaller(least, limit); },
               [&](int, const Command<Real>&, Real sum) { least = smaller(sum, least); });
    return least;
}

/// Control from pose k - 1 to k by a horizon of `steps` steps, given the belief at pose k - 1. A horizon of one step is
/// the greedy planner's.
template <class Layout, class Real, int capacity>
Command<Real> plan_ahead(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k, int steps,
                         HorizonWorkspace<Layout, Real>& work) {
    if (steps == 1) return plan(belief, given, k);
    Choice<Real> choice = no_choice<Real>(given.control);
    look_ahead(given, belief, k, steps, work.ahead, [&] { return choice.best; },
               [&](int, const Command<Real>& command, Real sum) { choice.offer(command, sum); });
    return choice.command;
}

/// Calls visit(i, cost) with the cost of every candidate, where all costs are wanted: that of its step or,
/// for several steps, the least sum over them. The planners themselves evaluate few candidates.
template <class Layout, class Real, int capacity, class Visit>
void price_candidates(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k, int steps,
                      HorizonWorkspace<Layout, Real>& work, Visit&& visit) {
    if (steps == 1)
        plan_plainly(belief, given.control, given.filter, given.sensor, given.layout, k, work.ahead[0], work.ahead[1],
                     visit);
    else
        look_ahead(given, belief, k, steps, work.ahead, without_limit<Real>,
                   [&](int i, const Command<Real>&, Real sum) { visit(i, sum); });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
