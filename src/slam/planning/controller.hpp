#pragma once
// The greedy planner: it takes the candidate whose next cost is least [docs/model.md, Controllers]. horizon.hpp plans
// several steps; baselines.hpp has the controllers that do not plan.

#include "slam/planning/criterion.hpp"
#include "slam/update.hpp"

namespace credence {

inline namespace CREDENCE_TARGET {

template <class Real>
Command<Real> command_from(const Control& control) {
    return {Real(control.turn), broadcast<Real>(control.move)};
}

/// Computes the part of the next step that is the same for all candidates: features predicted to pose k, and all edges
/// used for the update. (F and the fresh odometry noise affect the robot's rows only, so the edges may be used before
/// the robot moves.)
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void prepare_candidates(const Belief<Real, capacity>& belief, const FilterParameters& filter,
                                      const Layout& layout, int k, Belief<Real, capacity>& base) {
    const auto n = layout.size();
    each(zero, n, [&](auto i) { base.mean[i] = belief.mean[i]; });
    copy(belief.covariance, n, base.covariance);
    predict_features(base, filter, layout, k);
    each(zero, layout.features() - one, [&](auto c) {
        if (filter.contrasts[c].scale != 0)
            condition(base.covariance, layout, contrast_rows<Real>(filter, layout, c),
                      Real(filter.contrasts[c].scale * filter.variance_edge), all_lanes<Real>());
    });
}

/// The fresh position noise, which F does not affect.
template <class Layout, class Real, int capacity>
void add_odometry_noise(Symmetric<Real, capacity>& P, const FilterParameters& filter) {
    constexpr auto x = Layout::position;
    each(x, x + two, [&](auto i) { P.entry[i][i] = P.entry[i][i] + Real(filter.variance_odometry); });
}

/// The belief after one step under a candidate: predict, gate and compute sigma at the predicted mean, update P.
/// `sees(j, squared)` says where feature j, at a squared range, would be seen.
template <class Layout, class Real, int capacity, class Sees>
CREDENCE_FLAT void expect(const Belief<Real, capacity>& base, const Command<Real>& command,
                          const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                          const Sees& sees, Belief<Real, capacity>& next) {
    const auto n = layout.size();
    each(zero, n, [&](auto i) { next.mean[i] = base.mean[i]; });
    copy(base.covariance, n, next.covariance);
    predict_robot(next, filter, layout, command);
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_norm(predicted_difference<Layout>(next.mean, j));
        const Mask<Real> seen = sees(j, squared);
        if (any(seen))
            condition(next.covariance, layout, sighting_rows<Layout>(next.mean, j),
                      believed_variance(filter, sigma_at(sensor, squared)), seen);
    });
}

/// The same where every feature in range would be seen.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void expect(const Belief<Real, capacity>& base, const Command<Real>& command,
                          const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                          Belief<Real, capacity>& next) {
    expect(base, command, filter, sensor, layout,
           [&](auto, const Real& squared) CREDENCE_INLINE_LAMBDA { return in_range(sensor, squared); }, next);
}

/// The cost of a candidate, by the direct form: the oracle for the forms of planner.hpp. `next` receives the belief.
template <class Layout, class Real, int capacity>
Real candidate_cost(const Belief<Real, capacity>& base, const Command<Real>& command, const ControlParameters& control,
                    const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                    Belief<Real, capacity>& next) {
    expect(base, command, filter, sensor, layout, next);
    return cost_of(next.covariance, control, layout);
}

/// The smaller one; b where a is NaN.
template <class Real>
Real smaller(Real a, Real b) { return select(a < b, a, b); }

/// An upper bound on every cost.
template <class Real>
Real without_limit() { return Real(std::numeric_limits<double>::infinity()); }

/// Keeps the minimum so far and the choice: a candidate replaces the choice if its cost <= best (1 + 1e-12), or best +
/// 1e-11 where costs are logarithms, so that the last of equal candidates wins.
template <class Real>
struct Choice {
    Command<Real> command;
    Real best = without_limit<Real>();
    CostScale scale = CostScale::linear;

    Real equal_cost() const { return scale == CostScale::linear ? best * Real(1 + 1e-12) : best + Real(1e-11); }

    void offer(const Command<Real>& candidate, Real cost) { offer(candidate, cost, all_lanes<Real>()); }

    /// Offers a candidate in some lanes only.
    void offer(const Command<Real>& candidate, Real cost, Mask<Real> offered) {
        const Mask<Real> taken = both(offered, cost <= equal_cost());
        command.turn = select(taken, candidate.turn, command.turn);
        command.move.x = select(taken, candidate.move.x, command.move.x);
        command.move.y = select(taken, candidate.move.y, command.move.y);
        best = select(both(offered, cost < best), cost, best);
    }
};

/// Before the first candidate.
template <class Real>
Choice<Real> no_choice(const ControlParameters& control) {
    return {{}, without_limit<Real>(), scale_of(control.criterion)};
}

/// Where two candidates are equals.
template <class Real>
Mask<Real> same_move(const Command<Real>& a, const Command<Real>& b) {
    return both(a.move.x == b.move.x, a.move.y == b.move.y);
}

/// The first choice in some lanes, the second in the others.
template <class Real>
Choice<Real> chosen(Mask<Real> first, const Choice<Real>& a, const Choice<Real>& b) {
    return {{select(first, a.command.turn, b.command.turn),
             {select(first, a.command.move.x, b.command.move.x), select(first, a.command.move.y, b.command.move.y)}},
            select(first, a.best, b.best), a.scale};
}

/// Greedy control from pose k - 1 to k by the direct form, given the belief at pose k - 1. `costs(i, cost)` receives
/// every candidate's cost. `base` and `next` are workspace.
template <class Layout, class Real, int capacity, class Costs>
Choice<Real> plan_plainly(const Belief<Real, capacity>& belief, const ControlParameters& control,
                           const FilterParameters& filter, const SensorParameters& sensor, const Layout& layout,
                           int k, Belief<Real, capacity>& base, Belief<Real, capacity>& next, Costs&& costs) {
    prepare_candidates(belief, filter, layout, k, base);
    Choice<Real> choice = no_choice<Real>(control);
    for (int i = 0; i < control.candidate_count; ++i) {
        const Command<Real> candidate = command_from<Real>(control.candidates[i]);
        const Real cost = candidate_cost(base, candidate, control, filter, sensor, layout, next);
        costs(i, cost);
        choice.offer(candidate, cost);
    }
    return choice;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
