#pragma once
// The right-invariant extended Kalman filter [Barrau, Bonnabel 2017; Zhang, Wu, Song, Huang, Dissanayake 2017]: its
// error is an element of the group of rigid motions, eta = chi chi^^-1. In the Euclidean chart, which this program uses
// for every belief, it is the extended Kalman filter with two further lines after the update
// [docs/theory/estimators.md, Equations].

#include <credence/detail/elementary.hpp>
#include "slam/estimators/estimator.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// V(a) = [sin a, -(1 - cos a); 1 - cos a, sin a] / a, V(0) = I: a point's path under a turn by a.
template <class Real>
Rotation<Real> chord(Real a) {
    const Rotation<Real> half_turn = rotation(a * Real(0.5));
    const Mask<Real> turns = negated(a == Real(0));
    const Real ratio = half_turn.sine * Real(2) / select(turns, a, Real(1));  // 2 sin(a/2) / a, exact near 0
    return {select(turns, ratio * half_turn.cosine, Real(1)), select(turns, ratio * half_turn.sine, Real(0))};
}

/// P <- A P A', A = I with the column of theta (1; J s_r; J s_f): the points move along with an error of the heading.
/// `shift` [n] holds s at the index of each point.
template <class Layout, class Real, int capacity>
void turn_covariance(Symmetric<Real, capacity>& P, const Layout& layout, const Real* shift) {
    auto& e = P.entry;
    const int n = layout.size();
    Real a[capacity], old[capacity];
    for (int point = Layout::position; point < n; point += 2) {
        a[point] = -shift[point + 1];
        a[point + 1] = shift[point];
    }
    for (int i = Layout::position; i < n; ++i) {
        old[i] = e[0][i];
        e[0][i] = fma(a[i], e[0][0], e[0][i]);
    }
    for (int i = Layout::position; i < n; ++i)
        for (int j = i; j < n; ++j) e[i][j] = fma(a[i], e[0][j], fma(a[j], old[i], e[i][j]));
}

template <class Layout, class Real>
struct RightInvariantFilter : KalmanFilter<Layout, Real> {
    using typename KalmanFilter<Layout, Real>::State;

    /// The update of the Kalman filter, followed by x^ = x^- + V(delta_theta) delta for every point and P <- A P A'
    /// with s = x^ - x^-.
    template <class EdgeMeasurement, class Linearisation, class Updating>
    void update(State& belief, const FilterParameters& filter, const Layout& layout, const Sighting<Real>* sightings,
                const EdgeMeasurement& edge_measurement, const Linearisation& linearised, Updating& update) {
        condition_belief(belief, filter, layout, sightings, edge_measurement, linearised, update);
        Real* delta = update.correction;
        const Rotation<Real> V = chord(delta[Layout::heading]);
        for (int point = Layout::position; point < layout.size(); point += 2) {
            const Vector2<Real> shift = rotate(V, point_at(delta, point));
            delta[point] = shift.x;
            delta[point + 1] = shift.y;
        }
        for (int i = 0; i < layout.size(); ++i) belief.mean[i] = belief.mean[i] + delta[i];
        turn_covariance(belief.covariance, layout, delta);
        update.turned(layout, delta);
    }
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
