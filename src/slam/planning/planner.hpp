#pragma once
// The greedy planner's fast forms. All of them choose as controller.hpp's direct form does
// (tests/slam/planner_long_test.cpp).

#include "slam/planning/bounded.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

// Each form chooses from `work.still`. `limit` is a known upper bound on the cost. A choice is exact if its cost is at
// most `limit`, up to the tolerance of the tie rule; if no candidate's cost is, only that they cost more is certain.

/// The choice of a fast form, and the least cost of the candidates that it evaluated: the choice costs no more, unless
/// rounding has raised the bounds above the costs.
template <class Real>
struct FastChoice {
    Choice<Real> choice;
    Real met;
};

/// By screening, then deciding in the space of the measurements.
template <bool ranged, class Layout, class Real>
FastChoice<Real> choose_by_screening(const Planning<Layout, Real>& given, Real limit) {
    const auto& [control, filter, sensor, layout, work] = given;
    auto& still = work.still;
    auto& screening = work.screening;
    auto& space = work.space;
    const ValueParameters parameters = value_parameters(sensor, filter);
    const Rotation<Real> heading = given.heading();
    enter_measurement_space(still, filter, layout, control.weights, space);
    const auto cost = [&](const Command<Real>& command) {
        return cost_in_measurement_space(space, world_move<Layout>(heading, command.move), given.filter, given.sensor,
                                         given.layout, given.work.elimination);
    };
    FastChoice<Real> fast{{}, without_limit<Real>()};
    Choice<Real>& choice = fast.choice;
    for (int first = 0; first < control.candidate_count; first += screening_chunk) {
        const int left = control.candidate_count - first, count = left < screening_chunk ? left : screening_chunk;
        const Real reference = value_candidates<ranged>(still, heading, control, filter, sensor, layout, parameters,
                                                        first, count, screening);
        Command<Real> command = fetch_each(control, reference);
        const Tangent<Layout, Real> tangent =
            tangent_at(space.position + world_move<Layout>(heading, command.move), still, heading, filter, sensor,
                       layout, control.weights, parameters.kappa, screening);
        fast.met = smaller(cost(command), fast.met);
        const Real threshold = smaller(fast.met, smaller(choice.best, limit)) * Real(1 + 1e-9);
        screen<ranged>(tangent, threshold, control, layout, parameters, first, count, screening);
        for (Mask<Real> offered; any(offered = take_queued(control, first, screening, command));)
            choice.offer(command, cost(command), offered);
    }
    return fast;
}

/// For the translation model with constant noise and few features.
template <class Layout, class Real>
FastChoice<Real> choose_by_visible_sets(const Planning<Layout, Real>& given) {
    const auto& [control, filter, sensor, layout, work] = given;
    enter_measurement_space(work.still, filter, layout, control.weights, work.space);
    gather_sets(work.still, control, sensor, layout, work.sets);
    price_sets(work.space, filter, sensor, layout, work.elimination, work.sets);
    const Choice<Real> choice = choose_among_sets(work.still, control, sensor, layout, work.sets);
    return {choice, choice.best};
}

template <class Layout, class Real>
FastChoice<Real> choose_fast(const Planning<Layout, Real>& given, Real limit) {
    const bool ranged = given.sensor.noise == RangeNoise::ranged;
    if constexpr (!Layout::has_heading)
        if (!ranged && given.layout.features() <= largest_tabled_count) return choose_by_visible_sets(given);
    return ranged ? choose_by_screening<true>(given, limit) : choose_by_screening<false>(given, limit);
}

/// The lanes in which a fast form's choice is not reliable: rounding may have changed a cost by more than about one
/// part in 10^10, or no candidate was left with a cost as low as one that was evaluated. Where the covariance is not
/// finite the trial has failed, and where the limit is not positive every candidate lies above it: there the choice
/// does not matter.
template <class Layout, class Real>
Mask<Real> doubtful(const FastChoice<Real>& fast, Real limit, Real lost, const PlannerWorkspace<Layout, Real>& work) {
    const Mask<Real> matters = both(work.space.prior.constant < without_limit<Real>(), limit > Real(0));
    const Mask<Real> accurate = lost <= Real(4e4) * smaller(fast.met, limit);
    const Mask<Real> found = either(fast.choice.best <= fast.met, limit <= fast.met);
    return both(matters, negated(both(accurate, found)));
}

/// The best control from pose k - 1 to k, given the belief at pose k - 1: by a fast form; of a trace, by the direct one
/// in lanes where the fast one is not reliable.
template <class Layout, class Real, int capacity>
Choice<Real> choose(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k, Real limit) {
    const auto& [control, filter, sensor, layout, work] = given;
    if (!is_trace(control.criterion))
        return sensor.noise == RangeNoise::ranged ? choose_without_trace<true>(belief, given, k, limit)
                                                  : choose_without_trace<false>(belief, given, k, limit);
    prepare_still(belief, filter, layout, k, work.still);
    const FastChoice<Real> fast = choose_fast(given, limit);
    const Mask<Real> unsure = doubtful(fast, limit, lost_to_rounding(given, work.space.prior.constant, 0), work);
    if (!any(unsure)) return fast.choice;
    return chosen(unsure,
                  plan_plainly(belief, control, filter, sensor, layout, k, work.still, work.next, [](int, Real) {}),
                  fast.choice);
}

/// Greedy control from pose k - 1 to k, given the belief at pose k - 1.
template <class Layout, class Real, int capacity>
Command<Real> plan(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k) {
    return choose(belief, given, k, without_limit<Real>()).command;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
