#pragma once
// Room 7: the planner where the noise depends on the range: screen, then decide [docs/model.md, Screening].
//
//   P   covariance before the robot moves, all but the fresh heading noise added, edges taken in; heading, position, f
//   u   a candidate's move in the world, a = J u; d0 = f_j - r before the move; rows H0_j = [-J d0_j, -I, I]
//   r_j believed variance of sighting j; v_j = 1/(kappa + r_j), 0 where unseen
// In the old heading H0 does not depend on the candidate. Without the fresh heading noise, and with kappa below every
// eigenvalue of H0 P H0', trace(P+) is convex in v: its tangent at a reference bounds every candidate from below, for
// some twenty operations each. Those whose bound lies above the cost of a candidate that is known exactly are out.

#include <credence/lane.hpp>
#include <credence/turned_trace.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Candidates screened at a time.
inline constexpr int screening_chunk = 128;

template <class Layout, class Real>
struct ScreeningWorkspace {
    Real value[screening_chunk][Layout::feature_capacity];   ///< v_j of each candidate
    Symmetric<Real, Layout::capacity> covariance;            ///< of the reference
    TurnedTrace<Real> slope[Layout::feature_capacity];       ///< -d trace / d v_j
    int queue[lanes<Real>][screening_chunk];                 ///< each lane's candidates that are left, in order
    int queued[lanes<Real>];
};


/// kappa: with fresh feature noise q, and at most lambda for the largest eigenvalue of the edge graph's Laplacian,
/// P_ff >= (1/q + lambda/sigma_edge^2)^-1.
inline double least_feature_variance(const FilterParameters& filter) {
    const double edges = filter.edge_count > 0 ? filter.laplacian_bound / filter.variance_edge : 0;
    return filter.variance_feature > 0 ? 1 / (1 / filter.variance_feature + edges) : 0;
}

/// What v_j is made of: kappa, and the believed sigma at a range q, offset + slope q but at least near.
struct ValueParameters {
    double kappa = 0, near = 0, offset = 0, slope = 0;
    double constant = 0;  ///< v_j where the noise is constant
};

inline ValueParameters value_parameters(const SensorParameters& sensor, const FilterParameters& filter) {
    const double kappa = least_feature_variance(filter), factor = filter.measurement_factor;
    const double believed = factor * sensor.sigma;
    return {kappa, factor * sensor.sigma_near, factor * (sensor.sigma_near - sensor.sigma_slope * sensor.range_min),
            factor * sensor.sigma_slope, 1 / (believed * believed + kappa)};
}

/// v_j at a squared range within the sensor's, not below it: sigma grows with the range, so a range from below gives a
/// value from above. The margin covers the rounding.
template <bool ranged, class Real>
Real greatest_value(const ValueParameters& parameters, Real squared) {
    if constexpr (!ranged) return Real(parameters.constant * (1 + 1e-12));
    const Real line = fma(Real(parameters.slope), sqrt_from_below(squared), Real(parameters.offset));
    const Real sigma = select(line > Real(parameters.near), line, Real(parameters.near));
    return Real(1 + 1e-12) / fma(sigma, sigma, Real(parameters.kappa));
}

/// What a move costs the reference, in units of v per |u|^2: a move lets the heading's variance into the position's.
/// How much of trace(P) one v is worth is guessed: any reference will do, a good one leaves fewer candidates to decide.
template <class Layout, class Real, int capacity>
Real price_of_moving(const Belief<Real, capacity>& still, const FilterParameters& filter, const Layout& layout,
                     double kappa) {
    if (!Layout::has_heading || kappa == 0) return Real(0);
    const Real heading = still.covariance.entry[0][0] + Real(filter.variance_heading);
    return heading * Real(layout.features() / kappa) / trace(still.covariance, layout.size());
}

/// Values of the candidates first ... first + count - 1; returns, lane by lane, the number of the one that sees most,
/// less the price of its move.
template <bool ranged, class Layout, class Real, int capacity>
CREDENCE_FLAT Real value_candidates(const Belief<Real, capacity>& still, const Rotation<Real>& heading,
                                    const ControlParameters& control, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout,
                                    const ValueParameters& parameters, int first, int count,
                                    ScreeningWorkspace<Layout, Real>& work) {
    Real most = Real(-std::numeric_limits<double>::infinity()), reference = Real(first);
    const Real price = price_of_moving(still, filter, layout, parameters.kappa);
    const Vector2<Real> position = point_at(still.mean, Layout::position);
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> move = broadcast<Real>(control.candidates[first + i].move);
        const Vector2<Real> u = world_move<Layout>(heading, move), there = position + u;
        Real sum = Layout::has_heading ? -(price * squared_norm(u)) : Real(0);
        each(zero, layout.features(), [&](auto j) {
            const Real squared = squared_range(there, point_at(still.mean, Layout::feature(j)));
            const Real value = greatest_value<ranged>(parameters, squared);
            work.value[i][j] = select(in_range(sensor, squared), value, Real(0));
            sum = sum + work.value[i][j];
        });
        const Mask<Real> more = sum > most;
        most = select(more, sum, most);
        reference = select(more, Real(first + i), reference);
    }
    return reference;
}

/// |T W|^2 of W = A H0_j', times `weight`, as a polynomial in a.
template <class Layout, class Real, int capacity, class Rows>
TurnedTrace<Real> turned_norm(const Symmetric<Real, capacity>& A, const Layout& layout, const Rows& rows, Real weight) {
    Vector2<Real> W[capacity];
    TurnedTrace<Real> result;
    result.constant = Real(0);
    each(zero, layout.size(), [&](auto i) {
        W[i] = rows([&](auto s) { return A.at(i, s); });
        result.constant = fma(W[i].y, W[i].y, fma(W[i].x, W[i].x, result.constant));
    });
    result.constant = result.constant * weight;
    if constexpr (Layout::has_heading) {
        const Vector2<Real>& t = W[Layout::heading];
        const Vector2<Real>&x = W[Layout::position], &y = W[Layout::position + one];
        const Real twice = Real(2) * weight;
        result.linear = {twice * fma(x.y, t.y, x.x * t.x), twice * fma(y.y, t.y, y.x * t.x)};
        result.quadratic = weight * squared_norm(t);
    }
    return result;
}

/// Conditions on the sightings from `there`; fills the slopes and returns the tangent's part that no v changes.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT TurnedTrace<Real> tangent(const Belief<Real, capacity>& still, const Vector2<Real>& there,
                                        const FilterParameters& filter, const SensorParameters& sensor,
                                        const Layout& layout, double kappa, ScreeningWorkspace<Layout, Real>& work) {
    copy(still.covariance, layout.size(), work.covariance);
    Real value[Layout::feature_capacity], weight[Layout::feature_capacity];
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_range(there, point_at(still.mean, Layout::feature(j)));
        const Mask<Real> seen = in_range(sensor, squared);
        const Real N = believed_variance(filter, sigma_at(sensor, squared));
        value[j] = select(seen, Real(1) / (Real(kappa) + N), Real(0));
        const Real ratio = select(seen, Real(1) + Real(kappa) / N, Real(1));
        weight[j] = ratio * ratio;
        if (any(seen)) condition(work.covariance, layout, sighting_rows<Layout>(still.mean, j), N, seen);
    });
    TurnedTrace<Real> rest = turned_trace(work.covariance, layout);
    each(zero, layout.features(), [&](auto j) {
        work.slope[j] = turned_norm(work.covariance, layout, sighting_rows<Layout>(still.mean, j), weight[j]);
        rest.constant = fma(work.slope[j].constant, value[j], rest.constant);
        rest.linear = add_scaled(rest.linear, value[j], work.slope[j].linear);
        rest.quadratic = fma(work.slope[j].quadratic, value[j], rest.quadratic);
    });
    return rest;
}

/// The lowest cost that the tangent leaves to a candidate whose v_j are `value`.
template <class Layout, class Real>
Real bound_of(const TurnedTrace<Real>& rest, const Vector2<Real>& u, const Real* value, const Layout& layout,
              const ScreeningWorkspace<Layout, Real>& work) {
    const Vector2<Real> a{-u.y, u.x};
    const Real squared_a = squared_norm(u);
    Real bound = Layout::has_heading ? rest.at(a, squared_a) : rest.constant;
    each(zero, layout.features(), [&](auto j) {
        const Real slope = Layout::has_heading ? work.slope[j].at(a, squared_a) : work.slope[j].constant;
        bound = fnma(slope, value[j], bound);
    });
    return bound;
}

/// Queues, lane by lane and in order, the candidates whose bound does not lie above `threshold`.
template <class Layout, class Real>
CREDENCE_FLAT void screen(const TurnedTrace<Real>& rest, Real threshold, const Rotation<Real>& heading,
                          const ControlParameters& control, const Layout& layout, int first, int count,
                          ScreeningWorkspace<Layout, Real>& work) {
    for (int lane = 0; lane < lanes<Real>; ++lane) work.queued[lane] = 0;
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> u = world_move<Layout>(heading, broadcast<Real>(control.candidates[first + i].move));
        const Real bound = bound_of(rest, u, work.value[i], layout, work);
        for (unsigned left = lane_bits(negated(bound > threshold)); left != 0; left &= left - 1) {
            const int lane = __builtin_ctz(left);
            work.queue[lane][work.queued[lane]++] = first + i;
        }
    }
}

/// The queued candidates number `turn`, one for each lane; which lanes have one.
template <class Layout, class Real>
Mask<Real> fetch_queued(const ControlParameters& control, const ScreeningWorkspace<Layout, Real>& work, int turn,
                        Command<Real>& command) {
    Real has_one = Real(0);
    for (int lane = 0; lane < lanes<Real>; ++lane) {
        if (turn >= work.queued[lane]) continue;
        fetch(control, work.queue[lane][turn], lane, command);
        set_lane(has_one, lane, 1);
    }
    return has_one > Real(0);
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
