#pragma once
// Walls of the plane: what they hide, and how far a robot can move. Without branches on a Real.

#include "slam/world.hpp"
#include "worlds/explore/settings.hpp"

namespace credence {

/// A wall and what follows from its ends.
struct WallLine {
    Point from, to, direction;  ///< the direction has length 1
    double length = 0;
};

inline namespace CREDENCE_TARGET {

template <class Real>
Real cross_product(const Vector2<Real>& a, const Vector2<Real>& b) { return fnma(a.y, b.x, a.x * b.y); }
template <class Real>
Real dot_product(const Vector2<Real>& a, const Vector2<Real>& b) { return fma(a.x, b.x, a.y * b.y); }

/// Where the wall stands between `eye` and eye + way. A wall on which the end of the way lies hides nothing there, nor
/// does one along the way.
template <class Real>
Mask<Real> hides(const WallLine& wall, const Vector2<Real>& eye, const Vector2<Real>& way) {
    const Vector2<Real> along = broadcast<Real>({wall.to.x - wall.from.x, wall.to.y - wall.from.y}),
                        start = broadcast<Real>(wall.from) - eye;
    // They cross at the shares t/c of the way and u/c of the wall.
    const Real c = cross_product(way, along), squared = c * c, t = cross_product(start, along) * c,
               u = cross_product(start, way) * c;
    return both(both(squared > Real(0), both(t >= Real(0), t <= Real(1 - 1e-9) * squared)),
                both(u >= Real(0), u <= squared));
}

/// The share of a move from `place` at which the robot's centre comes as near to the wall as its radius; 1 where it
/// does not. Nearer than that, as a start can be, it moves away freely, and no step towards the wall.
template <class Real>
Real free_share(const WallLine& wall, double radius, const Vector2<Real>& place, const Vector2<Real>& move) {
    const Vector2<Real> along = broadcast<Real>(wall.direction), start = place - broadcast<Real>(wall.from);
    const Real side = cross_product(along, start), speed = cross_product(along, move);
    Real share(1);
    const auto meet = [&](Mask<Real> meets, Real at) {
        at = select(at > Real(0), at, Real(0));
        share = select(both(meets, at < share), at, share);
    };
    const Real at = (absolute(side) - Real(radius)) / absolute(speed),
               reached = fma(select(at > Real(0), at, Real(0)), dot_product(along, move), dot_product(along, start));
    meet(both(side * speed < Real(0), both(reached >= Real(0), reached <= Real(wall.length))), at);
    for (const Point* end : {&wall.from, &wall.to}) {  // the discs about both ends
        const Vector2<Real> from_end = place - broadcast<Real>(*end);
        const Real b = dot_product(from_end, move), c = squared_norm(from_end) - Real(radius * radius),
                   discriminant = fnma(squared_norm(move), c, b * b);
        const Mask<Real> meets = both(b < Real(0), discriminant >= Real(0));
        meet(meets, c / (sqrt(select(meets, discriminant, Real(0))) - b));
    }
    return share;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
