#pragma once
// Module numeric: what can be seen in the plane: range, field of view, walls between, and how near walls are; in lanes,
// without branches on a Real.

#include <credence/detail/functions.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A wall of the plane, both ends included.
struct Wall {
    Vector2<double> from, to;
};

/// What a sensor sees if nothing is in between. `cosine` is that of half its full field of view; -2 looks all round.
struct View {
    double nearest = 0, farthest = __builtin_inf(), cosine = -2;
};

/// Whether a point at this distance, `ahead` of it along the sensor's axis, is in range and in the field of view.
template <class Real>
Mask<Real> in_view(const View& view, Real ahead, Real distance) {
    return both(both(distance >= Real(view.nearest), distance <= Real(view.farthest)),
                ahead >= Real(view.cosine) * distance);
}

/// a_x b_y - a_y b_x: twice the area between two vectors, positive where b is to the left of a.
template <class Real>
Real cross(const Vector2<Real>& a, const Vector2<Real>& b) {
    return fma(a.x, b.y, -(a.y * b.x));
}

template <class Real>
Vector2<Real> in_lanes(const Vector2<double>& point) {
    return {Real(point.x), Real(point.y)};
}

/// Whether the way from a to b crosses one of the walls [count]. Their ends belong to them, so that nothing passes
/// where two of them meet. A way that begins or ends on a wall's line does not cross that wall.
template <class Real>
Mask<Real> segment_blocked(const Vector2<Real>& a, const Vector2<Real>& b, const Wall* walls, int count) {
    Mask<Real> blocked = negated(all_lanes<Real>());
    const Vector2<Real> way = b - a;
    for (int i = 0; i < count; ++i) {
        const Vector2<Real> from = in_lanes<Real>(walls[i].from) - a, to = in_lanes<Real>(walls[i].to) - a;
        const Real side_from = cross(way, from), side_to = cross(way, to);
        const Real side_a = cross(from, to), side_b = side_a - (side_to - side_from);
        const Mask<Real> across = either(both(side_a > Real(0), side_b < Real(0)),
                                         both(side_a < Real(0), side_b > Real(0)));
        const Mask<Real> between = either(both(side_from >= Real(0), side_to <= Real(0)),
                                          both(side_from <= Real(0), side_to >= Real(0)));
        blocked = either(blocked, both(across, between));
    }
    return blocked;
}

/// Distance from p to the nearest of the walls [count]; infinite where there are none.
template <class Real>
Real clearance(const Vector2<Real>& p, const Wall* walls, int count) {
    Real least = Real(__builtin_inf());
    for (int i = 0; i < count; ++i) {
        const Vector2<double> along = walls[i].to - walls[i].from;
        const double length = squared_norm(along);
        const Vector2<Real> from = p - in_lanes<Real>(walls[i].from), direction = in_lanes<Real>(along);
        const Real place = fma(from.x, direction.x, from.y * direction.y) * Real(length > 0 ? 1 / length : 0);
        const Real nearest = max(Real(0), min(Real(1), place));
        least = min(least, squared_norm(add_scaled(from, -nearest, direction)));
    }
    return sqrt(least);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
