#pragma once
// Planning several steps ahead, a receding horizon [docs/model.md, Controllers: horizon]. Of all sequences of
// candidates over the horizon, the one whose sum of trace(P) is least is found; its first control is taken, and at the
// next pose all is planned anew. On the way nothing is measured: each step is the one that the greedy planner expects
// of its candidate, from the mean and the covariance that the step before is expected to leave.

#include "slam/planning/planner.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The beliefs along a sequence, before the robot moves on: one for each step but the last, and room for the next one.
template <class Layout, class Real>
struct HorizonWorkspace {
    Belief<Real, Layout::capacity> ahead[largest_horizon];
};

/// What stays the same along all sequences.
template <class Layout, class Real>
struct Outlook {
    const ControlParameters& control;
    const FilterParameters& filter;
    const SensorParameters& sensor;
    const Layout& layout;
    PlannerWorkspace<Layout, Real>& last_step;
};

template <class Layout, class Real, int capacity>
Real least_sum(const Outlook<Layout, Real>& outlook, const Belief<Real, capacity>& belief, int k, int steps,
               Belief<Real, capacity>* ahead, Real limit);

/// Tells each candidate's least sum of trace(P) over `steps` > 1 steps, the candidate being the first of them:
/// told(i, command, sum). `belief` is that of pose k - 1, and may be ahead[0]; `limit()` as for least_sum. A covariance's
/// trace is positive: where the first one reaches the limit in all lanes, so does the sum, and the candidate is not told.
template <class Layout, class Real, int capacity, class Limit, class Told>
void look_ahead(const Outlook<Layout, Real>& outlook, const Belief<Real, capacity>& belief, int k, int steps,
                Belief<Real, capacity>* ahead, const Limit& limit, Told&& told) {
    const auto& [control, filter, sensor, layout, last_step] = outlook;
    prepare_candidates(belief, filter, layout, k, ahead[0]);
    for (int i = 0; i < control.candidate_count; ++i) {
        const Command<Real> command = command_from<Real>(control.candidates[i]);
        const Real next = candidate_cost(ahead[0], command, filter, sensor, layout, ahead[1]);
        // The margin covers the rounding of sums, and what the tie rule takes for equal.
        const Real rest = limit() * Real(1 + 1e-9) - next;
        if (any(negated(rest <= Real(0))))
            told(i, command, next + least_sum(outlook, ahead[1], k + 1, steps - 1, ahead + 1, rest));
    }
}

/// The least sum of trace(P) over `steps` steps from the belief at pose k - 1. Where it lies above `limit` it need not be
/// exact, only above it.
template <class Layout, class Real, int capacity>
Real least_sum(const Outlook<Layout, Real>& outlook, const Belief<Real, capacity>& belief, int k, int steps,
               Belief<Real, capacity>* ahead, Real limit) {
    if (steps == 1) {
        const auto& [control, filter, sensor, layout, last_step] = outlook;
        return choose(belief, control, filter, sensor, layout, k, limit, last_step).best;
    }
    Real least = without_limit<Real>();
    look_ahead(outlook, belief, k, steps, ahead, [&] { return smaller(least, limit); },
               [&](int, const Command<Real>&, Real sum) { least = smaller(sum, least); });
    return least;
}

/// Control from pose k - 1 to k by a horizon of `steps` steps, given the belief at pose k - 1. A horizon of one step is
/// the greedy planner's.
template <class Layout, class Real, int capacity>
Command<Real> plan_ahead(const Belief<Real, capacity>& belief, const ControlParameters& control,
                         const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                         int steps, HorizonWorkspace<Layout, Real>& work, PlannerWorkspace<Layout, Real>& last_step) {
    if (steps == 1) return plan(belief, control, filter, sensor, layout, k, last_step);
    const Outlook<Layout, Real> outlook{control, filter, sensor, layout, last_step};
    Choice<Real> choice;
    look_ahead(outlook, belief, k, steps, work.ahead, [&] { return choice.best; },
               [&](int, const Command<Real>& command, Real sum) { choice.offer(command, sum); });
    return choice.command;
}

/// Tells what every candidate costs, for whoever wants to know them all: told(i, cost), the trace(P) after its step or,
/// of more steps, the least sum over them. The planners themselves price few.
template <class Layout, class Real, int capacity, class Told>
void price_candidates(const Belief<Real, capacity>& belief, const ControlParameters& control,
                      const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                      int steps, HorizonWorkspace<Layout, Real>& work, PlannerWorkspace<Layout, Real>& last_step,
                      Told&& told) {
    if (steps == 1) {
        plan_plainly(belief, control, filter, sensor, layout, k, work.ahead[0], work.ahead[1], told);
        return;
    }
    look_ahead(Outlook<Layout, Real>{control, filter, sensor, layout, last_step}, belief, k, steps, work.ahead,
               without_limit<Real>, [&](int i, const Command<Real>&, Real sum) { told(i, sum); });
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
