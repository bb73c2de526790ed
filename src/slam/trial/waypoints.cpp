// The controls that lead a robot without noise along control.waypoints [docs/model.md, Controllers].

#include "slam/trial/problem.hpp"

#include <credence/detail/functions.hpp>

namespace credence {

namespace {

/// The place at a length along the path from (0, 0) through the waypoints; the last one beyond the path's end.
Point place_at(double length, const std::vector<Point>& waypoints) {
    Point from;
    for (const Point& to : waypoints) {
        const Point way{to.x - from.x, to.y - from.y};
        const double leg = sqrt(way.x * way.x + way.y * way.y);
        if (length < leg) return {from.x + length / leg * way.x, from.y + length / leg * way.y};
        length -= leg;
        from = to;
    }
    return from;
}

}  // namespace

std::vector<Control> waypoint_controls(const DeformableSettings& s) {
    std::vector<Control> controls;
    double heading = 0;
    for (int k = 0; k + 1 < s.poses; ++k) {
        const Point here = place_at(k * s.features.step, s.waypoints),
                    next = place_at((k + 1) * s.features.step, s.waypoints);
        Control control{0, {next.x - here.x, next.y - here.y}};
        const Point& way = control.move;
        if (way.x * way.x + way.y * way.y <= least_move * least_move * s.features.step * s.features.step) {
            control.move = {};
        } else if (s.process == Process::heading) {
            const Vector2<double> move = rotate_back(rotation(heading), {control.move.x, control.move.y});
            control = {atan2(move.y, move.x), {move.x, move.y}};
            heading += control.turn;
        }
        controls.push_back(control);
    }
    return controls;
}

}  // namespace credence
