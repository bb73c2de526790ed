#pragma once
// The controllers that do not plan [docs/model.md, Controllers].

#include "slam/planning/turned_trace.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Moves the robot to a place in the world, or towards it as far as the longest candidate moves. In the heading model
/// the robot turns into the direction of its move. The robot stays as it is if the place is closer than rounding.
template <class Layout, class Real, int capacity>
Command<Real> towards(const Vector2<Real>& place, const Belief<Real, capacity>& belief, double squared_reach) {
    Vector2<Real> move = place - point_at(belief.mean, Layout::position);
    const Real squared = squared_norm(move);
    const Mask<Real> far = squared > Real(squared_reach),
                     away = squared > Real(least_move * least_move * squared_reach);
    const Real share = select(far, sqrt(Real(squared_reach) / squared), Real(1));
    move = scaled(select(away, share, Real(0)), move);
    if constexpr (Layout::has_heading) {
        move = rotate_back(rotation(belief.mean[Layout::heading]), move);
        return {select(away, atan2(move.y, move.x), Real(0)), move};
    }
    return {Real(0), move};
}

/// The place of feature j that the filter predicts for pose k.
template <class Layout, class Real, int capacity>
Vector2<Real> predicted_place(const Belief<Real, capacity>& belief, const FilterParameters& filter, int k, int j) {
    const Point &t = filter.translation[k - 1], &d = filter.sway_increment_at(k, j);
    return point_at(belief.mean, Layout::feature(j)) + Vector2<Real>{Real(t.x + d.x), Real(t.y + d.y)};
}

/// The predicted centre of the features.
template <class Layout, class Real, int capacity>
Vector2<Real> centre_of_features(const Belief<Real, capacity>& belief, const FilterParameters& filter,
                                 const Layout& layout, int k) {
    Vector2<Real> sum{Real(0), Real(0)};
    for (int j = 0; j < layout.features(); ++j) sum = sum + predicted_place<Layout>(belief, filter, k, j);
    return scaled(Real(1.0 / layout.features()), sum);
}

/// The predicted place of the first feature whose variance is the largest of all, but for 10^-12 of it.
template <class Layout, class Real, int capacity>
Vector2<Real> least_known_feature(const Belief<Real, capacity>& belief, const FilterParameters& filter,
                                  const Layout& layout, int k) {
    const auto variance = [&](int j) {
        const auto& P = belief.covariance.entry;
        const int f = Layout::feature(j);
        return P[f][f] + P[f + 1][f + 1];
    };
    Real largest = variance(0);
    for (int j = 1; j < layout.features(); ++j) largest = select(variance(j) > largest, variance(j), largest);
    const Real enough = largest * Real(1 - 1e-12);
    Vector2<Real> place = predicted_place<Layout>(belief, filter, k, 0);
    Mask<Real> found = variance(0) >= enough;
    for (int j = 1; j < layout.features(); ++j) {
        const Vector2<Real> here = predicted_place<Layout>(belief, filter, k, j);
        place = {select(found, place.x, here.x), select(found, place.y, here.y)};
        found = either(found, variance(j) >= enough);
    }
    return place;
}

/// Control from pose k - 1 to k by a controller that does not plan, given the belief at pose k - 1.
template <class Layout, class Real, int capacity, class Noise>
Command<Real> steered(Controller controller, const Belief<Real, capacity>& belief, const ControlParameters& control,
                      const FilterParameters& filter, const Layout& layout, int k, const Noise& noise) {
    switch (controller) {
        case Controller::random:
            return fetch_each(control, noise.uniform(Source::control, k, 0) * Real(control.candidate_count));
        case Controller::nearest:
            return towards<Layout>(least_known_feature(belief, filter, layout, k), belief, control.squared_reach);
        case Controller::follow:
            return towards<Layout>(centre_of_features(belief, filter, layout, k), belief, control.squared_reach);
        case Controller::waypoints: return command_from<Real>(control.waypoints[k - 1]);
        default: return command_from<Real>(control.fixed[k - 1]);
    }
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
