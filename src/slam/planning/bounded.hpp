#pragma once
// The greedy planner by criteria that are no trace: bounds discard candidates, the direct form decides what is left.

#include "slam/planning/eigenvalue.hpp"
#include "slam/planning/workspace.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

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

/// What the bounds of a step's candidates have in common.
template <bool ranged, class Layout, class Real>
struct ScreenedStep {
    const Planning<Layout, Real>& given;
    Rotation<Real> heading = given.heading();
    ValueParameters parameters = value_parameters(given.sensor, given.filter);

    const Point& move(int candidate) const { return given.control.candidates[candidate].move; }
    Vector2<Real> world(const Command<Real>& command) const { return world_move<Layout>(heading, command.move); }

    /// v_j of candidate i of those that are screened.
    auto values(int i) const {
        return [&given = given, &parameters = parameters, i](auto j)
                   CREDENCE_INLINE_LAMBDA { return value_of<ranged>(given.work.screening, parameters, i, j); };
    }
};

/// By a determinant, of the state (`full`) or the pose.
template <bool full, bool ranged, class Layout, class Real>
struct DeterminantScreen : ScreenedStep<ranged, Layout, Real> {
    using Step = ScreenedStep<ranged, Layout, Real>;
    using Step::given, Step::heading, Step::parameters;
    Mask<Real> reliable;  ///< elsewhere no candidate is discarded

    explicit DeterminantScreen(const Planning<Layout, Real>& planning) : Step{planning} {
        const double value = largest_sighting_value(parameters, given.sensor);
        const Real lost = Real(value) * enter_determinant_space<full>(given.work.still, heading, given.filter,
                                                                      given.control.squared_reach, given.layout,
                                                                      given.work.determinants);
        // kappa v nearer to 1 loses the digits of 1 - kappa v, the noise's share.
        reliable = lost <= Real(parameters.kappa * value > 1 - 1e-6 ? 0 : 1e8);
    }

    /// Bounds are tangent at this candidate from now on. Returns its cost if that is known then.
    Real enter(const Command<Real>& command) {
        touch(command);
        return without_limit<Real>();
    }
    void touch(const Command<Real>& command) {
        touch_at<full>(this->world(command), given.filter, given.sensor, given.layout, parameters.kappa,
                       given.work.determinants, given.work.tangent);
    }
    Real direct(const Command<Real>& command) {
        return candidate_cost(given.work.still, command, given.control, given.filter, given.sensor, given.layout,
                              given.work.next);
    }
    Real bound(int first, int i) const {
        return determinant_bound<full>(given.work.tangent, given.work.determinants, given.layout, parameters.kappa,
                                       this->move(first + i), this->values(i));
    }
    /// What no bound of a candidate of at most this cost lies above.
    Real threshold(const Real& cost) const {
        return select(reliable, bounded_cost<full, Layout>(cost + Real(1e-6)), without_limit<Real>());
    }
    void decide(const Command<Real>& command, Mask<Real> offered, Real, Choice<Real>& choice) {
        choice.offer(command, direct(command), offered);
    }
};

/// By the largest eigenvalue, along the eigenvector that was found last.
template <bool ranged, class Layout, class Real>
struct EigenvalueScreen : ScreenedStep<ranged, Layout, Real> {
    using Step = ScreenedStep<ranged, Layout, Real>;
    using Step::given, Step::heading, Step::parameters;
    Real x[Layout::capacity];
    EigenvalueTangent<Layout, Real> tangent;
    Real lost;  ///< where it is too much, no candidate is discarded

    explicit EigenvalueScreen(const Planning<Layout, Real>& planning) : Step{planning} {
        each(zero, given.layout.size(), [&](auto i) { x[i] = Real(1); });
        const Weights& weights = given.control.weights;
        const double odometry = given.filter.variance_odometry;
        const double fresh = 2 * weights.position * odometry + weights.heading * given.filter.variance_heading;
        lost = lost_to_rounding(given, weighted_trace(given.work.still.covariance, given.layout, weights) + Real(fresh),
                                odometry);
    }

    Real enter(const Command<Real>& command) {
        const Real cost = direct(command);
        touch(command);
        return cost;
    }
    void touch(const Command<Real>& command) {
        touch_along(x, this->world(command), given.work.still, heading, given.filter, given.sensor, given.layout,
                    given.control.weights, parameters.kappa, given.work.screening.covariance, tangent);
    }
    /// Makes P+ that of the candidate.
    auto& expected(const Command<Real>& command) {
        expect(given.work.still, command, given.filter, given.sensor, given.layout, given.work.next);
        return given.work.next.covariance;
    }
    Real direct(const Command<Real>& command) {
        auto& P = expected(command);
        return largest_eigenvalue_below(above_eigenvalues(P, given.layout, given.control.weights), all_lanes<Real>(),
                                        P, given.control.weights, given.layout, given.work.screening.covariance, x);
    }
    Real bound(int first, int i) const { return tangent.bound(this->move(first + i), given.layout, this->values(i)); }
    Real threshold(const Real& cost) const {
        const Mask<Real> accurate = either(lost <= Real(4e4) * cost, cost <= Real(0));
        return select(accurate, cost * Real(1 + 1e-9), without_limit<Real>());
    }
    /// Most candidates are only shown to lie above the least one so far: along x or, failing that, by a factorisation.
    void decide(const Command<Real>& command, Mask<Real> offered, Real limit, Choice<Real>& choice) {
        const auto& [control, filter, sensor, layout, work] = given;
        auto& P = expected(command);
        const Real threshold = smaller(choice.best, limit) * Real(1 + 1e-9);
        offered = both(offered, negated(value_along(x, P, layout, control.weights) > threshold));
        if (!any(offered)) return;
        offered = both(offered, all_below(threshold, P, layout, control.weights));
        if (!any(offered)) return;
        // From far above all of them the iteration loses its digits.
        const Real high = smaller(threshold, above_eigenvalues(P, layout, control.weights));
        choice.offer(command, largest_eigenvalue_below(high, offered, P, control.weights, layout,
                                                       work.screening.covariance, x), offered);
    }
};

/// The candidate whose cost is least: those that bounds do not show to cost more than one whose cost is known are
/// decided by the direct form. `limit` is as in planner.hpp.
template <template <bool, class, class> class Screen, bool ranged, class Layout, class Real, int capacity>
Choice<Real> choose_by_bounds(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k,
                              Real limit) {
    const auto& [control, filter, sensor, layout, work] = given;
    auto& screening = work.screening;
    prepare_candidates(belief, filter, layout, k, work.still);
    Screen<ranged, Layout, Real> screen(given);
    Choice<Real> choice = no_choice<Real>(control);
    for (int first = 0; first < control.candidate_count; first += screening_chunk) {
        const int rest = control.candidate_count - first, count = rest < screening_chunk ? rest : screening_chunk;
        const auto bound_of = [&](int i) CREDENCE_INLINE_LAMBDA { return screen.bound(first, i); };
        Command<Real> command =
            fetch_each(control, value_candidates<ranged>(work.still, screen.heading, control, filter, sensor, layout,
                                                         screen.parameters, first, count, screening));
        Choice<Real> known = no_choice<Real>(control);
        known.offer(command, screen.enter(command));
        command = fetch_each(control, bound_candidates<false>(first, count, screening, bound_of));
        const Mask<Real> met = both(known.best < without_limit<Real>(), same_move(command, known.command));
        if (any(negated(met))) known.offer(command, screen.direct(command));
        const Real least = smaller(smaller(known.best, choice.best), limit), threshold = screen.threshold(least);
        if (mark_left(control.repeated + first, count, threshold, screening) > enough_left) {
            screen.touch(command);
            bound_candidates<true>(first, count, screening, bound_of);
            mark_left(control.repeated + first, count, threshold, screening);
        }
        queue_left(count, screening);
        for (Mask<Real> offered; any(offered = take_queued(control, first, screening, command));) {
            const Mask<Real> again = both(offered, same_move(command, known.command));
            choice.offer(command, known.best, again);
            offered = both(offered, negated(again));
            if (any(offered)) screen.decide(command, offered, least, choice);
        }
    }
    return choice;
}

template <bool ranged, class Layout, class Real>
using StateDeterminantScreen = DeterminantScreen<true, ranged, Layout, Real>;
template <bool ranged, class Layout, class Real>
using PoseDeterminantScreen = DeterminantScreen<false, ranged, Layout, Real>;

/// For the translation model with constant noise and few features, by the direct form's costs.
template <class Layout, class Real, int capacity>
Choice<Real> choose_by_set_costs(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k) {
    const auto& [control, filter, sensor, layout, work] = given;
    prepare_still(belief, filter, layout, k, work.still);
    gather_sets(work.still, control, sensor, layout, work.sets);
    const auto none = layout.features() - layout.features();
    price_sets_directly(none, 0, work.still.covariance, work.still, control, filter, sensor, layout, work.sets);
    return choose_among_sets(work.still, control, sensor, layout, work.sets);
}

template <bool ranged, class Layout, class Real, int capacity>
Choice<Real> choose_without_trace(const Belief<Real, capacity>& belief, const Planning<Layout, Real>& given, int k,
                                  Real limit) {
    if constexpr (!Layout::has_heading && !ranged)
        if (given.layout.features() <= largest_tabled_count) return choose_by_set_costs(belief, given, k);
    switch (given.control.criterion) {
        case Criterion::log_det: return choose_by_bounds<StateDeterminantScreen, ranged>(belief, given, k, limit);
        case Criterion::pose_log_det: return choose_by_bounds<PoseDeterminantScreen, ranged>(belief, given, k, limit);
        default: return choose_by_bounds<EigenvalueScreen, ranged>(belief, given, k, limit);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
