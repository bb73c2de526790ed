#pragma once
// Room 7: the greedy planner's fast forms. All of them choose as controller.hpp's plain form does (tests/planner).

#include <credence/screening.hpp>
#include <credence/visible_sets.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

template <class Layout, class Real>
struct PlannerWorkspace {
    Belief<Real, Layout::capacity> still;  ///< before the robot moves, all of the step's noise added but the heading's
    ScreeningWorkspace<Layout, Real> screening;
    MeasurementSpace<Layout, Real> space;
    MeasurementElimination<Layout, Real> elimination;
    VisibleSets<Real> sets;
};

/// Everything of the step that no candidate changes: prepare_candidates, and the robot's fresh position noise, which F
/// does not touch.
template <class Layout, class Real, int capacity>
void prepare_still(const Belief<Real, capacity>& belief, const FilterParameters& filter, const Layout& layout, int k,
                   Belief<Real, capacity>& still) {
    prepare_candidates(belief, filter, layout, k, still);
    constexpr auto x = Layout::position;
    each(x, x + two, [&](auto i) {
        still.covariance.entry[i][i] = still.covariance.entry[i][i] + Real(filter.variance_odometry);
    });
}

// Each form chooses from `work.still`. Whoever knows of something that costs `limit` says so: a choice that costs no more,
// or so little more that the tie rule takes it for equal, is exact; of a dearer one it is only certain that it is dearer.

/// By screening, then deciding in the space of the measurements.
template <bool ranged, class Layout, class Real>
Choice<Real> choose_by_screening(const ControlParameters& control, const FilterParameters& filter,
                                 const SensorParameters& sensor, const Layout& layout, Real limit,
                                 PlannerWorkspace<Layout, Real>& work) {
    auto& still = work.still;
    auto& screening = work.screening;
    auto& space = work.space;
    const ValueParameters parameters = value_parameters(sensor, filter);
    Rotation<Real> heading{};
    if constexpr (Layout::has_heading) heading = rotation(still.mean[Layout::heading]);
    enter_measurement_space(still, filter, layout, space);
    const auto cost = [&](const Command<Real>& command) {
        return cost_in_measurement_space(space, world_move<Layout>(heading, command.move), filter, sensor, layout,
                                         work.elimination);
    };
    Choice<Real> choice;
    for (int first = 0; first < control.candidate_count; first += screening_chunk) {
        const int left = control.candidate_count - first, count = left < screening_chunk ? left : screening_chunk;
        const Real reference = value_candidates<ranged>(still, heading, control, filter, sensor, layout, parameters,
                                                        first, count, screening);
        Command<Real> command = fetch_each(control, reference);
        const Tangent<Layout, Real> tangent =
            tangent_at(space.position + world_move<Layout>(heading, command.move), still, heading, filter, sensor,
                       layout, parameters.kappa, screening);
        const Real threshold = smaller(cost(command), smaller(choice.best, limit)) * Real(1 + 1e-9);
        screen<ranged>(tangent, threshold, control, layout, parameters, first, count, screening);
        for (Mask<Real> offered; any(offered = take_queued(control, first, screening, command));)
            choice.offer(command, cost(command), offered);
    }
    return choice;
}

/// For the translation model with constant noise and few features.
template <class Layout, class Real>
Choice<Real> choose_by_visible_sets(const ControlParameters& control, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout,
                                    PlannerWorkspace<Layout, Real>& work) {
    enter_measurement_space(work.still, filter, layout, work.space);
    gather_sets(work.still, control, sensor, layout, work.sets);
    price_sets(work.space, filter, sensor, layout, work.elimination, work.sets);
    const Real best = least_cost(1 << layout.features(), work.sets);
    return {fetch_each(control, last_of_best(best, work.still, control, sensor, layout, work.sets)), best};
}

template <class Layout, class Real>
Choice<Real> choose(const ControlParameters& control, const FilterParameters& filter, const SensorParameters& sensor,
                    const Layout& layout, Real limit, PlannerWorkspace<Layout, Real>& work) {
    if constexpr (!Layout::has_heading)
        if (sensor.noise == RangeNoise::constant && layout.features() <= largest_tabled_count)
            return choose_by_visible_sets(control, filter, sensor, layout, work);
    if (sensor.noise == RangeNoise::ranged)
        return choose_by_screening<true>(control, filter, sensor, layout, limit, work);
    return choose_by_screening<false>(control, filter, sensor, layout, limit, work);
}

/// Greedy control from pose k - 1 to k, given the belief at pose k - 1.
template <class Layout, class Real, int capacity>
Command<Real> plan(const Belief<Real, capacity>& belief, const ControlParameters& control,
                   const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                   PlannerWorkspace<Layout, Real>& work) {
    prepare_still(belief, filter, layout, k, work.still);
    return choose(control, filter, sensor, layout, without_limit<Real>(), work).command;
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
