#pragma once
// The planner where the noise depends on the range: screen, then decide [docs/theory/model.md, Screening].
//
//   P   covariance before the robot moves, all but the fresh heading noise added, edges taken in; heading, position, f
//   u   a candidate's move in the world, a = J u; d0 = f_j - r before the move; rows H0_j = [-J d0_j, -I, I]
//   r_j believed variance of sighting j; v_j = 1/(kappa + r_j), 0 where unseen; W the weights of the trace
// In the frame of the old heading H0 does not depend on the candidate. Without the fresh heading noise, and with kappa
// below every eigenvalue of H0 P H0', trace(W P+) is convex in v: its tangent at a reference bounds every candidate
// from below, for some twenty operations each. Candidates whose bound lies above an exact cost that is already known
// are discarded.

#include <credence/detail/lane.hpp>
#include "slam/planning/turned_trace.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Number of candidates that are screened at a time.
inline constexpr int screening_chunk = 128;

template <class Layout, class Real>
struct ScreeningWorkspace {
    Real value[screening_chunk][Layout::feature_capacity];       ///< v_j of each candidate, where the noise is ranged
    Mask<Real> seen[screening_chunk][Layout::feature_capacity];  ///< where it is constant: whether v_j is not 0
    Symmetric<Real, Layout::capacity> covariance;                ///< of the reference
    Real bound[screening_chunk];                                 ///< of each candidate, where bounds are compared twice
    std::uint8_t left[screening_chunk];                          ///< bits of the lanes in which each candidate is left
    std::uint64_t queue[lanes<Real>][screening_chunk / 64];      ///< bits of the candidates that are left in each lane
};

/// kappa: with fresh feature noise q, and at most lambda for the largest eigenvalue of the edge graph's Laplacian,
/// P_ff >= (1/q + lambda/sigma_edge^2)^-1.
inline double least_feature_variance(const FilterParameters& filter) {
    const double edges = filter.edge_count > 0 ? filter.laplacian_bound / filter.variance_edge : 0;
    return filter.variance_feature > 0 ? 1 / (1 / filter.variance_feature + edges) : 0;
}

/// The parameters of v_j: kappa, and the assumed sigma at a range q, offset + slope q but at least near.
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

/// An upper bound on v_j at a squared range within the sensor's: sigma grows with the range, so a lower bound on the
/// range gives an upper bound on v_j. The margin covers the rounding.
template <bool ranged, class Real>
Real greatest_value(const ValueParameters& parameters, Real squared) {
    if constexpr (!ranged) return Real(parameters.constant * (1 + 1e-12));
    const Real line = fma(Real(parameters.slope), sqrt_from_below(squared), Real(parameters.offset));
    const Real sigma = select(line > Real(parameters.near), line, Real(parameters.near));
    return Real(1 + 1e-12) / fma(sigma, sigma, Real(parameters.kappa));
}

/// The largest v_j that a sighting can have.
inline double largest_sighting_value(const ValueParameters& parameters, const SensorParameters& sensor) {
    if (sensor.noise == RangeNoise::constant) return parameters.constant;
    return 1 / (parameters.near * parameters.near + parameters.kappa);
}

/// The price of a move when the reference is chosen, in units of v per |u|^2: a move lets the heading's variance into
/// the position's. How much of trace(P) one v is worth is a guess: any reference is valid, a good one leaves fewer
/// candidates to evaluate.
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
    // Local copies: the compiler knows that no value written here changes them.
    Vector2<Real> feature[Layout::feature_capacity];
    each(zero, layout.features(), [&](auto j) { feature[j] = point_at(still.mean, Layout::feature(j)); });
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> move = broadcast<Real>(control.candidates[first + i].move);
        const Vector2<Real> u = world_move<Layout>(heading, move), there = position + u;
        Real sum = Layout::has_heading ? -(price * squared_norm(u)) : Real(0);
        each(zero, layout.features(), [&](auto j) {
            const Real squared = squared_range(there, feature[j]);
            const Mask<Real> seen = in_range(sensor, squared);
            const Real value = select(seen, greatest_value<ranged>(parameters, squared), Real(0));
            if constexpr (ranged)
                work.value[i][j] = value;
            else
                work.seen[i][j] = seen;
            sum = sum + value;
        });
        const Mask<Real> more = sum > most;
        most = select(more, sum, most);
        reference = select(more, Real(first + i), reference);
    }
    return reference;
}

/// v_j of candidate i, as computed by value_candidates.
template <bool ranged, class Layout, class Real, class Index>
Real value_of(const ScreeningWorkspace<Layout, Real>& work, const ValueParameters& parameters, int i, Index j) {
    if constexpr (ranged) return work.value[i][j];
    return select(work.seen[i][j], greatest_value<ranged>(parameters, Real(0)), Real(0));
}

/// trace(W T B B' T') of B = A H0_j', times `factor`, as a polynomial in a.
template <class Layout, class Real, int capacity, class Rows>
TurnedTrace<Real> turned_norm(const Symmetric<Real, capacity>& A, const Layout& layout, const Weights& weights,
                              const Rows& rows, Real factor) {
    Vector2<Real> B[capacity];
    TurnedTrace<Real> result{};
    each(zero, layout.size(), [&](auto i) {
        B[i] = rows([&](auto s) { return A.at(i, s); });
        const Real weight = Real(weight_at<Layout>(weights, i));
        result.constant = fma(weight * B[i].y, B[i].y, fma(weight * B[i].x, B[i].x, result.constant));
    });
    result.constant = result.constant * factor;
    if constexpr (Layout::has_heading) {
        const Vector2<Real>& t = B[Layout::heading];
        const Vector2<Real>&x = B[Layout::position], &y = B[Layout::position + one];
        const Real once = Real(weights.position) * factor, twice = Real(2) * once;
        result.linear = {twice * fma(x.y, t.y, x.x * t.x), twice * fma(y.y, t.y, y.x * t.x)};
        result.quadratic = once * squared_norm(t);
    }
    return result;
}

/// A polynomial in a = J R(theta^) v as one in v, a candidate's move in the body frame, which is the same in all lanes.
template <class Layout, class Real>
TurnedTrace<Real> in_body_frame(const TurnedTrace<Real>& trace, const Rotation<Real>& heading) {
    if constexpr (!Layout::has_heading) return trace;
    return {trace.constant, trace.quadratic, rotate_back(heading, Vector2<Real>{trace.linear.y, -trace.linear.x})};
}

/// The tangent at a reference, by the move in the body frame.
template <class Layout, class Real>
struct Tangent {
    TurnedTrace<Real> rest;                            ///< the part that does not depend on any v_j
    TurnedTrace<Real> slope[Layout::feature_capacity]; ///< -d trace / d v_j

    /// The lower bound on the cost of a candidate whose v_j are value(j).
    template <class Value>
    Real bound(const Point& move, const Layout& layout, const Value& value) const {
        const Vector2<Real> v = broadcast<Real>(move);
        const Real squared = Real(move.x * move.x + move.y * move.y);
        const auto at_move = [&](const TurnedTrace<Real>& trace) {
            return Layout::has_heading ? trace.at(v, squared) : trace.constant;
        };
        Real least = at_move(rest);
        each(zero, layout.features(), [&](auto j) { least = fnma(at_move(slope[j]), value(j), least); });
        return least;
    }
};

/// Conditions P on what is seen from `there`; gives the sightings' v_j and (1 + kappa/r_j)^2, 1 where it is not seen.
template <class Layout, class Real, int capacity>
CREDENCE_INLINE void condition_from(const Vector2<Real>& there, const Real* mean, const FilterParameters& filter,
                                    const SensorParameters& sensor, const Layout& layout, double kappa,
                                    Symmetric<Real, capacity>& P, Real* value, Real* weight) {
    each(zero, layout.features(), [&](auto j) {
        const Real squared = squared_range(there, point_at(mean, Layout::feature(j)));
        const Mask<Real> seen = in_range(sensor, squared);
        const Real N = believed_variance(filter, sigma_at(sensor, squared));
        value[j] = select(seen, Real(1) / (Real(kappa) + N), Real(0));
        const Real ratio = select(seen, Real(1) + Real(kappa) / N, Real(1));
        weight[j] = ratio * ratio;
        if (any(seen)) condition(P, layout, sighting_rows<Layout>(mean, j), N, seen);
    });
}

/// The tangent at the reference, whose move is `there`.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT Tangent<Layout, Real> tangent_at(const Vector2<Real>& there, const Belief<Real, capacity>& still,
                                               const Rotation<Real>& heading, const FilterParameters& filter,
                                               const SensorParameters& sensor, const Layout& layout,
                                               const Weights& weights, double kappa,
                                               ScreeningWorkspace<Layout, Real>& work) {
    copy(still.covariance, layout.size(), work.covariance);
    Real value[Layout::feature_capacity], weight[Layout::feature_capacity];
    condition_from(there, still.mean, filter, sensor, layout, kappa, work.covariance, value, weight);
    Tangent<Layout, Real> tangent;
    TurnedTrace<Real> rest = turned_trace(work.covariance, layout, weights);
    each(zero, layout.features(), [&](auto j) {
        const TurnedTrace<Real> slope =
            turned_norm(work.covariance, layout, weights, sighting_rows<Layout>(still.mean, j), weight[j]);
        rest.constant = fma(slope.constant, value[j], rest.constant);
        rest.linear = add_scaled(rest.linear, value[j], slope.linear);
        rest.quadratic = fma(slope.quadratic, value[j], rest.quadratic);
        tangent.slope[j] = in_body_frame<Layout>(slope, heading);
    });
    tangent.rest = in_body_frame<Layout>(rest, heading);
    return tangent;
}

/// Eight rows of eight bits, a byte each, with rows and columns exchanged [Warren, Hacker's Delight, 2nd edition, 7-3].
inline std::uint64_t transposed_bits(std::uint64_t rows) {
    const auto exchange = [&](int distance, std::uint64_t which) {
        const std::uint64_t different = (rows ^ (rows >> distance)) & which;
        rows ^= different ^ (different << distance);
    };
    exchange(7, 0x00aa00aa00aa00aau);
    exchange(14, 0x0000cccc0000ccccu);
    exchange(28, 0x00000000f0f0f0f0u);
    return rows;
}

/// Queues, in each lane, those of `count` candidates that are not discarded in it.
template <class Layout, class Real>
void queue_left(int count, ScreeningWorkspace<Layout, Real>& work) {
    for (auto& queue : work.queue)
        for (std::uint64_t& word : queue) word = 0;
    for (int i = count; i % 8 != 0; ++i) work.left[i] = 0;
    for (int i = 0; i < count; i += 8) {
        std::uint64_t candidates = 0;
        for (int next = 0; next < 8; ++next) candidates |= std::uint64_t{work.left[i + next]} << (8 * next);
        if (candidates == 0) continue;
        const std::uint64_t of_lanes = transposed_bits(candidates);
        for (int lane = 0; lane < lanes<Real>; ++lane)
            work.queue[lane][i / 64] |= (of_lanes >> (8 * lane) & 0xff) << (i % 64);
    }
}

/// If more candidates than this are left in some lane, bounds at a second reference are worth their time.
inline constexpr int enough_left = 8;

/// Marks the `count` candidates whose bound does not lie above `threshold`, but those whose move a later one repeats:
/// equals, of which the later wins. Returns how many are left in some lane.
template <class Layout, class Real>
int mark_left(const bool* repeated, int count, Real threshold, ScreeningWorkspace<Layout, Real>& work) {
    int left = 0;
    for (int i = 0; i < count; ++i) {
        work.left[i] = static_cast<std::uint8_t>(repeated[i] ? 0 : lane_bits(negated(work.bound[i] > threshold)));
        left += work.left[i] != 0;
    }
    return left;
}

/// Queues, in each lane, the candidates first ... first + count - 1 whose bound does not lie above `threshold`.
template <bool ranged, class Layout, class Real>
CREDENCE_FLAT void screen(const Tangent<Layout, Real>& tangent, Real threshold, const ControlParameters& control,
                          const Layout& layout, const ValueParameters& parameters, int first, int count,
                          ScreeningWorkspace<Layout, Real>& work) {
    static_assert(lanes<Real> <= 8);
    for (int i = 0; i < count; ++i) {
        const Real bound = tangent.bound(control.candidates[first + i].move, layout,
                                         [&](auto j) { return value_of<ranged>(work, parameters, i, j); });
        work.left[i] = static_cast<std::uint8_t>(lane_bits(negated(bound > threshold)));
    }
    queue_left(count, work);
}

/// Removes the first candidate, counted from `first`, from each lane's queue. Returns the lanes that had one.
template <class Layout, class Real>
Mask<Real> take_queued(const ControlParameters& control, int first, ScreeningWorkspace<Layout, Real>& work,
                       Command<Real>& command) {
    static_assert(screening_chunk == 128, "two words a queue");
    unsigned offered = 0;
    for (int lane = 0; lane < lanes<Real>; ++lane) {
        const int start = work.queue[lane][0] != 0 ? 0 : 64;
        std::uint64_t& queue = work.queue[lane][start / 64];
        if (queue == 0) continue;
        fetch(control, first + start + __builtin_ctzll(queue), lane, command);
        queue &= queue - 1;
        offered |= 1u << lane;
    }
    return mask_of_bits<Real>(offered);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
