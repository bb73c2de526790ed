#pragma once
// The controller `horizon` of the world `explore`: the first control of the sequence whose sum of costs is least, as of
// slam/planning/horizon.hpp, among those of which no wall ends a step [docs/explore.md]. The last step of each is the
// greedy planner's.

#include "worlds/explore/planner.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

template <class Real, int capacity, int features>
Real least_sum_among_walls(const ExploreView& problem, const Belief<Real, capacity>& belief,
                           const Truth<Real, features>& truth, const ExploreLayout& layout, int k, int steps,
                           Belief<Real, capacity>* ahead, ExploreState<Real>& work);

/// Calls visit(i, command, sum, allowed) for every candidate as the first of `steps` > 1 steps from the belief at pose
/// k - 1: the least sum of costs over these. `ahead` [steps] is room for beliefs; of the cells in view there is a row
/// for each step behind `work.viewed`.
template <class Real, int capacity, int features, class Visit>
void look_ahead_among_walls(const ExploreView& problem, const Belief<Real, capacity>& belief,
                            const Truth<Real, features>& truth, const ExploreLayout& layout, int k, int steps,
                            Belief<Real, capacity>* ahead, ExploreState<Real>& work, const Visit& visit) {
    const int cells = problem.grid.count();
    Mask<Real>*const viewed = work.viewed, *const next = viewed + cells;
    const auto view_as_now = [&] {
        for (int i = 0; i < cells; ++i) next[i] = viewed[i];
    };
    const Real of_absent = cost_of_absent(problem, layout, work);
    prepare_candidates(belief, problem.filter, layout, k, ahead[0]);
    view_as_now();
    each_candidate_ahead(
        problem, ahead[0].mean, work, [&](int cell, Mask<Real> fresh) { next[cell] = either(next[cell], fresh); },
        [&](int i, const Command<Real>& command, Mask<Real> allowed, const auto& sees, const Real& new_cells) {
            const Real none(__builtin_inf());
            Real sum = none;
            if (any(allowed)) {
                expect(ahead[0], command, problem.filter, problem.sensor, layout, sees, ahead[1]);
                const Real own = cost_of(ahead[1].covariance, problem.control, layout) - of_absent -
                                 Real(problem.coverage) * new_cells;
                work.viewed = next;
                sum = own + least_sum_among_walls(problem, ahead[1], truth, layout, k + 1, steps - 1, ahead + 1, work);
                work.viewed = viewed;
            }
            view_as_now();
            visit(i, command, sum, both(allowed, sum < none));
        });
}

/// The least sum of costs over `steps` steps from the belief at pose k - 1; infinite where a wall ends every sequence.
template <class Real, int capacity, int features>
Real least_sum_among_walls(const ExploreView& problem, const Belief<Real, capacity>& belief,
                           const Truth<Real, features>& truth, const ExploreLayout& layout, int k, int steps,
                           Belief<Real, capacity>* ahead, ExploreState<Real>& work) {
    if (steps == 1) {
        ExplorePlanner planner(problem, false, belief, truth, layout, k, work);
        planner.choose([](int, double, bool) {});
        return planner.least();
    }
    Real least(__builtin_inf());
    look_ahead_among_walls(problem, belief, truth, layout, k, steps, ahead, work,
                           [&](int, const Command<Real>&, const Real& sum, Mask<Real> allowed) {
        least = select(both(allowed, sum < least), sum, least);
    });
    return least;
}

/// The control from pose k - 1 to k. Calls costs(i, sum, allowed) with the candidates of the first lane.
template <class Real, int capacity, int features, class Costs>
Command<Real> plan_among_walls(const ExploreView& problem, const Belief<Real, capacity>& belief,
                               const Truth<Real, features>& truth, const ExploreLayout& layout, int k,
                               ExploreState<Real>& work, const Costs& costs) {
    const int steps = problem.steps_ahead(Controller::horizon, k);
    if (steps == 1) return ExplorePlanner(problem, false, belief, truth, layout, k, work).choose(costs);
    Choice<Real> choice = no_choice<Real>(problem.control);
    if (problem.coverage > 0) choice.scale = CostScale::logarithmic;  // costs can be negative
    look_ahead_among_walls(problem, belief, truth, layout, k, steps, work.ahead, work,
                           [&](int i, const Command<Real>& command, const Real& sum, Mask<Real> allowed) {
        choice.offer(command, sum, allowed);
        costs(i, lane_of(sum, 0), lane_bits(allowed) & 1);
    });
    return choice.command;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
