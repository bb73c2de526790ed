#pragma once
// Room 7: the planner of the translation model where the noise is constant. What a candidate costs depends on nothing
// but which features it sees: of the candidates that see the same, the last one wins, and each set is priced once.

#include <credence/measurement_space.hpp>

namespace credence {
inline namespace CREDENCE_UNIT {

/// Up to this many features, every set of them has a place in a table.
inline constexpr int largest_tabled_count = 6;

template <class Real>
struct VisibleSets {
    static constexpr int capacity = 1 << largest_tabled_count;
    double last[capacity][lanes<Real>];  ///< the last candidate that sees the set, -1 for none
    Real cost[capacity];
};

/// Finds, lane by lane, the last candidate of every set. Feature j is bit j of a set.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void gather_sets(const Belief<Real, capacity>& still, const ControlParameters& control,
                               const SensorParameters& sensor, const Layout& layout, VisibleSets<Real>& sets) {
    for (int set = 0; set < 1 << layout.features(); ++set)
        for (double& last : sets.last[set]) last = -1;
    const Vector2<Real> position = point_at(still.mean, Layout::position);
    for (int i = 0; i < control.candidate_count; ++i) {
        const Vector2<Real> there = position + broadcast<Real>(control.candidates[i].move);
        Real set = Real(0);
        each(zero, layout.features(), [&](auto j) {
            const Real squared = squared_range(there, point_at(still.mean, Layout::feature(j)));
            set = set + select(in_range(sensor, squared), Real(1 << j), Real(0));
        });
        for (int lane = 0; lane < lanes<Real>; ++lane) sets.last[static_cast<int>(lane_of(set, lane))][lane] = i;
    }
}

/// trace(P+) of every set.
template <class Layout, class Real>
CREDENCE_FLAT void price_sets(const MeasurementSpace<Layout, Real>& space, const FilterParameters& filter,
                              const SensorParameters& sensor, const Layout& layout,
                              MeasurementElimination<Layout, Real>& work, VisibleSets<Real>& sets) {
    const Real N = believed_variance(filter, Real(sensor.sigma));
    near_at_hand(layout, work, [&](auto& near) CREDENCE_INLINE_LAMBDA {
        for (int set = 0; set < 1 << layout.features(); ++set) {
            each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
                near.seen[j] = all_lanes<Real>();
                each(j, layout.features(), [&](auto l) CREDENCE_INLINE_LAMBDA {
                    near.S[j][l] = space.A[j][l], near.C[j][l] = space.G[j][l];
                });
                near.S[j][j] = add_noise(near.S[j][j], N);
            });
            Real cost = space.prior.constant;
            each(zero, layout.features(), [&](auto j) CREDENCE_INLINE_LAMBDA {
                if (set >> j & 1) cost = cost - take_out(layout, j, near);
            });
            sets.cost[set] = cost;
        }
    });
}

/// Where some candidate sees the set.
template <class Real>
Mask<Real> offered(int set, const VisibleSets<Real>& sets) { return load<Real>(sets.last[set]) >= Real(0); }

/// The least cost of the sets that some candidate sees; infinity where there is none.
template <class Real>
Real least_cost(int set_count, const VisibleSets<Real>& sets) {
    Real least = without_limit<Real>();
    for (int set = 0; set < set_count; ++set)
        least = select(both(offered(set, sets), sets.cost[set] < least), sets.cost[set], least);
    return least;
}

/// The number of the candidate that wins in each lane, -1 for none: of the sets that some candidate sees, those within
/// 1e-12 of the least cost; of those, the last candidate.
template <class Real>
Real last_of_best(int set_count, Real best, const VisibleSets<Real>& sets) {
    Real winner = Real(-1);
    for (int set = 0; set < set_count; ++set) {
        const Real last = load<Real>(sets.last[set]);
        const Mask<Real> good = both(offered(set, sets), sets.cost[set] <= best * Real(1 + 1e-12));
        winner = select(both(good, last > winner), last, winner);
    }
    return winner;
}

}  // namespace CREDENCE_UNIT
}  // namespace credence
