#pragma once
// The greedy planner's fast forms. All of them choose as controller.hpp's direct form does
// (tests/slam/planner_long_test.cpp).

#include "slam/planning/determinant.hpp"
#include "slam/planning/eigenvalue.hpp"
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
    DeterminantSpace<Layout, Real> determinants;
    DeterminantTangent<Layout, Real> tangent;
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

/// The choice among the sets, given their costs.
template <class Layout, class Real, int capacity>
FastChoice<Real> choose_among_sets(const Belief<Real, capacity>& still, const ControlParameters& control,
                                   const SensorParameters& sensor, const Layout& layout, VisibleSets<Real>& sets) {
    Choice<Real> choice = no_choice<Real>(control);
    choice.best = least_cost(1 << layout.features(), sets);
    choice.command =
        fetch_each(control, last_of_best(choice.equal_cost(), still, control, sensor, layout, sets));
    return {choice, choice.best};
}

/// For the translation model with constant noise and few features.
template <class Layout, class Real>
FastChoice<Real> choose_by_visible_sets(const ControlParameters& control, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout,
                                    PlannerWorkspace<Layout, Real>& work) {
    enter_measurement_space(work.still, filter, layout, control.weights, work.space);
    gather_sets(work.still, control, sensor, layout, work.sets);
    price_sets(work.space, filter, sensor, layout, work.elimination, work.sets);
    return choose_among_sets(work.still, control, sensor, layout, work.sets);
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

/// Bounds on the costs of `count` candidates from `first` on, bound_of(i) that of the ith; returns the number of
/// the least, lane by lane. With `again`, the greater of these and those that are there, for the candidates that are
/// left in some lane.
template <bool again, class Layout, class Real, class BoundOf>
CREDENCE_FLAT Real bound_candidates(int first, int count, ScreeningWorkspace<Layout, Real>& screening,
                                    const BoundOf& bound_of) {
    Real least = without_limit<Real>(), number = Real(first);
    for (int i = 0; i < count; ++i) {
        if (again && screening.left[i] == 0) continue;
        Real bound = bound_of(i);
        if (again) bound = select(bound > screening.bound[i], bound, screening.bound[i]);
        screening.bound[i] = bound;
        number = select(bound <= least, Real(first + i), number);  // the last of equals
        least = select(bound <= least, bound, least);
    }
    return number;
}

/// Screening by a determinant; the direct form decides.
template <bool full, bool ranged, class Layout, class Real>
struct DeterminantScreen {
    const ControlParameters& control;
    const FilterParameters& filter;
    const SensorParameters& sensor;
    const Layout& layout;
    PlannerWorkspace<Layout, Real>& work;
    Rotation<Real> heading{};
    ValueParameters parameters = value_parameters(sensor, filter);
    Mask<Real> reliable{};

    void start() {
        if constexpr (Layout::has_heading) heading = rotation(work.still.mean[Layout::heading]);
        const double value = largest_sighting_value(parameters, sensor);
        const Real lost = Real(value) * enter_determinant_space<full>(work.still, heading, filter,
                                                                      control.squared_reach, layout, work.determinants);
        // kappa v nearer to 1 loses the digits of 1 - kappa v, the noise's share.
        reliable = lost <= Real(parameters.kappa * value > 1 - 1e-6 ? 0 : 1e8);
    }
    Real direct(const Command<Real>& command) {
        return candidate_cost(work.still, command, control, filter, sensor, layout, work.next);
    }
    void touch(const Command<Real>& command) {
        touch_at<full>(world_move<Layout>(heading, command.move), filter, sensor, layout, parameters.kappa,
                       work.determinants, work.tangent);
    }
    Real bound(int first, int i) const {
        return determinant_bound<full>(work.tangent, work.determinants, layout, parameters.kappa,
                                       control.candidates[first + i].move, [&](auto j) CREDENCE_INLINE_LAMBDA {
                                           return value_of<ranged>(work.screening, parameters, i, j);
                                       });
    }
    Real threshold(const Real& cost) const {
        return select(reliable, bounded_cost<full, Layout>(cost + Real(1e-6)), without_limit<Real>());
    }
};

/// The candidate whose log det P+, of the state (`full`) or the pose, is least: those that bounds do not show to cost
/// more than one whose cost is known are decided by the direct form. `limit` is as above.
template <bool full, bool ranged, class Layout, class Real, int capacity>
Choice<Real> choose_by_determinant(const Belief<Real, capacity>& belief, const ControlParameters& control,
                                   const FilterParameters& filter, const SensorParameters& sensor,
                                   const Layout& layout, int k, Real limit, PlannerWorkspace<Layout, Real>& work) {
    auto& screening = work.screening;
    prepare_candidates(belief, filter, layout, k, work.still);
    DeterminantScreen<full, ranged, Layout, Real> screen{control, filter, sensor, layout, work};
    screen.start();
    Choice<Real> choice = no_choice<Real>(control);
    for (int first = 0; first < control.candidate_count; first += screening_chunk) {
        const int rest = control.candidate_count - first, count = rest < screening_chunk ? rest : screening_chunk;
        const auto bound_of = [&](int i) CREDENCE_INLINE_LAMBDA { return screen.bound(first, i); };
        screen.touch(fetch_each(control, value_candidates<ranged>(work.still, screen.heading, control, filter, sensor,
                                                                  layout, screen.parameters, first, count, screening)));
        const Real least = bound_candidates<false>(first, count, screening, bound_of);
        Command<Real> command = fetch_each(control, least);
        const Real met = screen.direct(command);
        const Real threshold = screen.threshold(smaller(smaller(met, choice.best), limit));
        if (mark_left(control.repeated + first, count, threshold, screening) > enough_left) {
            screen.touch(command);
            bound_candidates<true>(first, count, screening, bound_of);
            mark_left(control.repeated + first, count, threshold, screening);
        }
        queue_left(count, screening);
        if (alone(least - Real(first), screening)) {
            choice.offer(command, met);
            continue;
        }
        for (Mask<Real> offered; any(offered = take_queued(control, first, screening, command));)
            choice.offer(command, screen.direct(command), offered);
    }
    return choice;
}

/// The candidate whose largest eigenvalue is least. Most candidates are only shown to lie above the least one so far:
/// along the eigenvector that was found last or, failing that, by a factorisation. `limit` is as above.
template <bool ranged, class Layout, class Real, int capacity>
Choice<Real> choose_by_eigenvalue(const Belief<Real, capacity>& belief, const ControlParameters& control,
                                  const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                                  int k, Real limit, PlannerWorkspace<Layout, Real>& work) {
    prepare_candidates(belief, filter, layout, k, work.still);
    auto& P = work.next.covariance;
    auto& room = work.screening.covariance;
    Rotation<Real> heading{};
    if constexpr (Layout::has_heading) heading = rotation(belief.mean[Layout::heading]);
    const int count = control.candidate_count < screening_chunk ? control.candidate_count : screening_chunk;
    const Real reference = value_candidates<ranged>(work.still, heading, control, filter, sensor, layout,
                                                    value_parameters(sensor, filter), 0, count, work.screening);
    Real x[capacity];
    each(zero, layout.size(), [&](auto i) { x[i] = Real(1); });
    expect(work.still, fetch_each(control, reference), filter, sensor, layout, work.next);
    const Real met = largest_eigenvalue_below(above_eigenvalues(P, layout, control.weights), all_lanes<Real>(), P,
                                              control.weights, layout, room, x);
    Choice<Real> choice = no_choice<Real>(control);
    Real threshold = smaller(met, limit) * Real(1 + 1e-9);
    for (int i = 0; i < control.candidate_count; ++i) {
        if (control.repeated[i]) continue;  // a later one is its equal
        const Command<Real> candidate = command_from<Real>(control.candidates[i]);
        expect(work.still, candidate, filter, sensor, layout, work.next);
        if (!any(negated(value_along(x, P, layout, control.weights) > threshold))) continue;
        const Mask<Real> below = all_below(threshold, P, layout, control.weights);
        if (!any(below)) continue;
        // From far above all of them the iteration loses its digits.
        const Real high = smaller(threshold, above_eigenvalues(P, layout, control.weights));
        choice.offer(candidate, largest_eigenvalue_below(high, below, P, control.weights, layout, room, x), below);
        threshold = smaller(choice.best * Real(1 + 1e-9), threshold);
    }
    return choice;
}

/// For the translation model with constant noise and few features, by the direct form's costs.
template <class Layout, class Real, int capacity>
Choice<Real> choose_by_set_costs(const Belief<Real, capacity>& belief, const ControlParameters& control,
                                 const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                                 int k, PlannerWorkspace<Layout, Real>& work) {
    prepare_still(belief, filter, layout, k, work.still);
    gather_sets(work.still, control, sensor, layout, work.sets);
    const auto none = layout.features() - layout.features();
    price_sets_directly(none, 0, work.still.covariance, work.still, control, filter, sensor, layout, work.sets);
    return choose_among_sets(work.still, control, sensor, layout, work.sets).choice;
}

template <bool ranged, class Layout, class Real, int capacity>
Choice<Real> choose_without_trace(const Belief<Real, capacity>& belief, const ControlParameters& control,
                                  const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                                  int k, Real limit, PlannerWorkspace<Layout, Real>& work) {
    if constexpr (!Layout::has_heading && !ranged)
        if (layout.features() <= largest_tabled_count)
            return choose_by_set_costs(belief, control, filter, sensor, layout, k, work);
    switch (control.criterion) {
        case Criterion::log_det:
            return choose_by_determinant<true, ranged>(belief, control, filter, sensor, layout, k, limit, work);
        case Criterion::pose_log_det:
            return choose_by_determinant<false, ranged>(belief, control, filter, sensor, layout, k, limit, work);
        default: return choose_by_eigenvalue<ranged>(belief, control, filter, sensor, layout, k, limit, work);
    }
}

/// The best control from pose k - 1 to k, given the belief at pose k - 1: by a fast form; of a trace, by the direct one
/// in lanes where the fast one is not reliable.
template <class Layout, class Real, int capacity>
Choice<Real> choose(const Belief<Real, capacity>& belief, const ControlParameters& control,
                    const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout, int k,
                    Real limit, PlannerWorkspace<Layout, Real>& work) {
    if (!is_trace(control.criterion)) {
        if (sensor.noise == RangeNoise::ranged)
            return choose_without_trace<true>(belief, control, filter, sensor, layout, k, limit, work);
        return choose_without_trace<false>(belief, control, filter, sensor, layout, k, limit, work);
    }
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
