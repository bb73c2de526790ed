#pragma once
// The greedy planner's fast forms. All of them choose as controller.hpp's direct form does
// (tests/slam/planner_long_test.cpp).

#include "slam/planning/screening.hpp"
#include "slam/planning/visible_sets.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

template <class Layout, class Real>
struct PlannerWorkspace {
    Belief<Real, Layout::capacity> still;  ///< before the robot moves, with all of the step's noise but the heading's
    Belief<Real, Layout::capacity> next;   ///< after a candidate, where the direct form decides
    ScreeningWorkspace<Layout, Real> screening;
    MeasurementSpace<Layout, Real> space;
    MeasurementElimination<Layout, Real> elimination;
    VisibleSets<Real> sets;
};

/// Computes the part of the step that is the same for all candidates: that of prepare_candidates, and the robot's fresh
/// position noise, which F does not affect.
template <class Layout, class Real, int capacity>
void prepare_still(const Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout, int k,
                   Belief<Real, capacity>& still) {
    prepare_candidates(belief, filter, layout, k, still);
    constexpr auto x = Layout::position;
    each(x, x + two, [&](auto i) {
        still.covariance.entry[i][i] = still.covariance.entry[i][i] + Real(filter.variance_odometry);
    });
}

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
FastChoice<Real> choose_by_screening(const ControlParameters& control, const FilterParameters& filter,
                                 const SensorParameters& sensor, const Layout& layout, Real limit,
                                 PlannerWorkspace<Layout, Real>& work) {
    auto& still = work.still;
    auto& screening = work.screening;
    auto& space = work.space;
    const ValueParameters parameters = value_parameters(sensor, filter);
    Rotation<Real> heading{};
    if constexpr (Layout::has_heading) heading = rotation(still.mean[Layout::heading]);
    enter_measurement_space(still, filter, layout, control.weights, space);
    const auto cost = [&](const Command<Real>& command) {
        return cost_in_measurement_space(space, world_move<Layout>(heading, command.move), filter, sensor, layout,
                                         work.elimination);
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
FastChoice<Real> choose_by_visible_sets(const ControlParameters& control, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout,
                                    PlannerWorkspace<Layout, Real>& work) {
    enter_measurement_space(work.still, filter, layout, control.weights, work.space);
    gather_sets(work.still, control, sensor, layout, work.sets);
    price_sets(work.space, filter, sensor, layout, work.elimination, work.sets);
    const Real best = least_cost(1 << layout.features(), work.sets);
    return {{fetch_each(control, last_of_best(best, work.still, control, sensor, layout, work.sets)), best}, best};
}

template <class Layout, class Real>
FastChoice<Real> choose_fast(const ControlParameters& control, const FilterParameters& filter,
                             const SensorParameters& sensor, const Layout& layout, Real limit,
                             PlannerWorkspace<Layout, Real>& work) {
    if constexpr (!Layout::has_heading)
        if (sensor.noise == RangeNoise::constant && layout.features() <= largest_tabled_count)
            return choose_by_visible_sets(control, filter, sensor, layout, work);
    if (sensor.noise == RangeNoise::ranged)
        return choose_by_screening<true>(control, filter, sensor, layout, limit, work);
    return choose_by_screening<false>(control, filter, sensor, layout, limit, work);
}

/// T (1 + s v): the error of a fast form's costs is at most about 50 * 2^-53 times this [docs/theory/model.md,
/// Rounding]. T is at least the trace before the sightings, s at least the sum of the terms of S without the noise, v
/// at least the inverse of any eigenvalue of S.
template <class Layout, class Real>
CREDENCE_FLAT Real lost_to_rounding(const ControlParameters& control, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout,
                                    const PlannerWorkspace<Layout, Real>& work) {
    constexpr auto x = Layout::position;
    const auto& P = work.still.covariance.entry;
    const Real position = P[x][x] + P[x + one][x + one], reach = Real(control.squared_reach);
    const Real moved = Real(control.weights.position) * reach;
    Real T = work.space.prior.constant, s = Real(0);
    if constexpr (Layout::has_heading) T = fma(moved, P[Layout::heading][Layout::heading], T);
    each(zero, layout.features(), [&](auto j) {
        const auto f = Layout::feature(j);
        s = s + position + P[f][f] + P[f + one][f + one];
        if constexpr (Layout::has_heading) {
            const Real heading = P[Layout::heading][Layout::heading] + Real(filter.variance_heading);
            s = fma(heading, reach + squared_range(work.space.position, work.space.feature[j]), s);
        }
    });
    return fma(s * Real(largest_sighting_value(value_parameters(sensor, filter), sensor)), T, T);
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

/// The candidate whose largest eigenvalue is least. Most candidates are only shown to lie above the least one so far,
/// by a factorisation each. `limit` is as above.
template <class Layout, class Real, int capacity>
Choice<Real> choose_by_eigenvalue(const Belief<Real, capacity>& belief, const ControlParameters& control,
                                  const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                                  int k, Real limit, PlannerWorkspace<Layout, Real>& work) {
    prepare_candidates(belief, filter, layout, k, work.still);
    Choice<Real> choice = no_choice<Real>(control);
    for (int i = 0; i < control.candidate_count; ++i) {
        const Command<Real> candidate = command_from<Real>(control.candidates[i]);
        expect(work.still, candidate, filter, sensor, layout, work.next);
        const Real threshold = smaller(choice.best, limit) * Real(1 + 1e-9);
        if (any(all_below(threshold, work.next.covariance, layout, control.weights)))
            choice.offer(candidate, cost_of(work.next.covariance, control, layout));
    }
    return choice;
}

/// The best control from pose k - 1 to k, given the belief at pose k - 1: by a fast form, and by the direct one in
/// lanes where the fast one is not reliable. Of the criteria that are no traces only the eigenvalue has one.
template <class Layout, class Real, int capacity>
Choice<Real> choose(const Belief<Real, capacity>& belief, const ControlParameters& control,
                    const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                    Real limit, PlannerWorkspace<Layout, Real>& work) {
    if (control.criterion == Criterion::max_eigenvalue)
        return choose_by_eigenvalue(belief, control, filter, sensor, layout, k, limit, work);
    if (!is_trace(control.criterion))
        return plan_plainly(belief, control, filter, sensor, layout, k, work.still, work.next, [](int, Real) {});
    prepare_still(belief, filter, layout, k, work.still);
    const FastChoice<Real> fast = choose_fast(control, filter, sensor, layout, limit, work);
    const Mask<Real> unsure = doubtful(fast, limit, lost_to_rounding(control, filter, sensor, layout, work), work);
    if (!any(unsure)) return fast.choice;
    return chosen(unsure,
                  plan_plainly(belief, control, filter, sensor, layout, k, work.still, work.next, [](int, Real) {}),
                  fast.choice);
}

/// Greedy control from pose k - 1 to k, given the belief at pose k - 1.
template <class Layout, class Real, int capacity>
Command<Real> plan(const Belief<Real, capacity>& belief, const ControlParameters& control,
                   const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                   PlannerWorkspace<Layout, Real>& work) {
    return choose(belief, control, filter, sensor, layout, k, without_limit<Real>(), work).command;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
