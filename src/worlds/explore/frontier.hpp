#pragma once
// The controller `frontier` of the world `explore`: towards the nearest cell that was not in view [docs/explore.md].

#include "slam/planning/baselines.hpp"
#include "worlds/explore/planner.hpp"

namespace credence {
inline namespace CREDENCE_TARGET {

/// The cell that a place is in, or the nearest one.
inline int cell_at(const CellGrid& grid, double x, double y) {
    const auto index = [&](double along, int count) {
        const double cells = along / grid.cell;
        return !(cells > 0) ? 0 : cells < count ? static_cast<int>(cells) : count - 1;
    };
    return index(y - grid.corner.y, grid.rows) * grid.columns + index(x - grid.corner.x, grid.columns);
}

/// The first cell on a shortest way through the grid from cell `start` to one that was not in view in that lane; -1 if
/// none is reached. Of equal ways the first one to be found, neighbours taken to the east, north, west and south.
template <class Real>
int towards_unviewed(const CellGrid& grid, int start, int lane, ExploreState<Real>& work) {
    for (int i = 0; i < grid.count(); ++i) work.from[i] = -1;
    work.from[start] = start;
    work.queue[0] = start;
    for (int next = 0, end = 1; next < end; ++next) {
        int cell = work.queue[next];
        if (cell != start && !(lane_bits(work.viewed[cell]) >> lane & 1)) {
            while (work.from[cell] != start) cell = work.from[cell];
            return cell;
        }
        for (int direction = 0; direction < 4; ++direction) {
            const int neighbour = grid.neighbour(cell, direction);
            if (!(grid.ways[cell] >> direction & 1) || work.from[neighbour] >= 0) continue;
            work.from[neighbour] = cell;
            work.queue[end++] = neighbour;
        }
    }
    return -1;
}

/// To the centre of the next cell on the way to the frontier or, where a wall stands before it, to that of its own.
template <class Real, int capacity>
Command<Real> towards_frontier(const ExploreView& problem, const Belief<Real, capacity>& belief,
                               ExploreState<Real>& work) {
    const Vector2<Real> here = point_at(belief.mean, ExploreLayout::position);
    Vector2<Real> place = here;
    for (int lane = 0; lane < lanes<Real>; ++lane) {
        const double x = lane_of(here.x, lane), y = lane_of(here.y, lane);
        const int own = cell_at(problem.grid, x, y), next = towards_unviewed(problem.grid, own, lane, work);
        if (next < 0) continue;
        Point centre = problem.grid.centre(next);
        for (int w = 0; w < problem.wall_count; ++w)
            if (free_share<double>(problem.walls[w], problem.radius, {x, y}, {centre.x - x, centre.y - y}) < 1) {
                centre = problem.grid.centre(own);
                break;
            }
        set_lane(place.x, lane, centre.x);
        set_lane(place.y, lane, centre.y);
    }
    return towards<ExploreLayout>(place, belief, problem.control.squared_reach);
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
