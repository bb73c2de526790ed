#pragma once
// What the robot of the world `explore` has in view: landmarks, and the cells of its grid.

#include "slam/sensor.hpp"
#include "worlds/explore/problem.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// Where a point at the displacement `way` from the eye is inside the view and behind no wall, whatever its range.
template <class Real>
Mask<Real> in_sight(const ExploreView& problem, const Vector2<Real>& eye, const Rotation<Real>& heading,
                   const Vector2<Real>& way, const Real& squared) {
    Mask<Real> seen = all_lanes<Real>();
    if (!problem.sees_all_round)
        seen = dot_product({heading.cosine, heading.sine}, way) >= Real(problem.cosine_half_view) * sqrt(squared);
    for (int i = 0; i < problem.wall_count && any(seen); ++i)
        seen = both(seen, negated(hides(problem.walls[i], eye, way)));
    return seen;
}

/// Calls visit(i, seen) for the cells that are in sight in some lane in which open(i) is true.
template <class Real, class Open, class Visit>
void each_new_cell(const ExploreView& problem, const Vector2<Real>& eye, const Rotation<Real>& heading,
                   const Open& open, const Visit& visit) {
    const CellGrid& grid = problem.grid;
    for (int i = 0; i < grid.count(); ++i) {
        Mask<Real> fresh = open(i);
        if (!any(fresh)) continue;
        const Vector2<Real> way = broadcast<Real>(grid.centre(i)) - eye;
        const Real squared = squared_norm(way);
        fresh = both(fresh, squared <= Real(problem.sensor.squared_range_max));
        if (any(fresh)) fresh = both(fresh, in_sight(problem, eye, heading, way, squared));
        if (any(fresh)) visit(i, fresh);
    }
}

/// Notes what has come into view. Returns the share of all cells that it is.
template <class Real>
Real view_cells(const ExploreView& problem, const Vector2<Real>& eye, const Rotation<Real>& heading,
                Mask<Real>* viewed) {
    Real count(0);
    each_new_cell(
        problem, eye, heading, [&](int i) { return negated(viewed[i]); },
        [&](int i, Mask<Real> fresh) {
            viewed[i] = either(viewed[i], fresh);
            count = count + select(fresh, Real(1), Real(0));
        });
    return count * Real(1.0 / problem.grid.count());
}

/// The robot's motion from pose k - 1 to k as the deformable world's, but a wall ends it. Returns where one did.
template <class Layout, class Real, int capacity, class Draws>
Mask<Real> move_among_walls(Truth<Real, capacity>& truth, const ExploreView& problem, const Command<Real>& command,
                            const Draws& draws) {
    const bool noisy = problem.motion_noise == MotionNoise::motion;
    const WorldParameters& world = problem.world;
    const Vector2<Real> before = truth.position,
                        after = add_scaled(before + rotate(truth.rotation, command.move),
                                           Real(noisy ? world.sigma_odometry : 0), draws.position());
    const Vector2<Real> move = after - before;
    Real share(1);
    for (int i = 0; i < problem.wall_count; ++i) {
        const Real own = free_share(problem.walls[i], problem.radius, before, move);
        share = select(own < share, own, share);
    }
    const Mask<Real> stopped = share < Real(1);
    const Vector2<Real> end = add_scaled(before, share, move);
    truth.position = {select(stopped, end.x, after.x), select(stopped, end.y, after.y)};
    truth.heading = fma(Real(noisy ? world.sigma_heading : 0), draws.heading(), truth.heading + command.turn);
    truth.rotation = rotation(truth.heading);
    return stopped;
}

/// What the filter is given of the motion: omega - sigma_head eps, v - sigma_odom eps where the noise is on that.
template <class Real, class Draws>
Command<Real> reported(const ExploreView& problem, const Command<Real>& command, const Draws& draws) {
    if (problem.motion_noise == MotionNoise::motion) return command;
    return {fnma(Real(problem.world.sigma_heading), draws.heading(), command.turn),
            add_scaled(command.move, Real(-problem.world.sigma_odometry), draws.position())};
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
