#pragma once
// The dependence of a trace on a candidate's move. F = T is the identity but for T[r, theta] = a = J u, u the move in
// the world; so trace(T A T') is a polynomial in a whose coefficients are the same for all candidates.

#include "slam/planning/controller.hpp"
#include <credence/detail/lane.hpp>

namespace credence {
inline namespace CREDENCE_TARGET {

/// constant + a . linear + |a|^2 quadratic. In the translation model there is only the constant.
template <class Real>
struct TurnedTrace {
    Real constant, quadratic;
    Vector2<Real> linear;

    Real at(const Vector2<Real>& a, Real squared_a) const {
        return fma(a.x, linear.x, fma(a.y, linear.y, fma(squared_a, quadratic, constant)));
    }
};

/// trace(W T A T'), T = I but T[r, theta] = a, as a polynomial in a.
template <class Layout, class Real, int capacity>
TurnedTrace<Real> turned_trace(const Symmetric<Real, capacity>& A, const Layout& layout, const Weights& weights) {
    TurnedTrace<Real> result{};
    result.constant = weighted_trace(A, layout, weights);
    if constexpr (Layout::has_heading) {
        constexpr auto t = Layout::heading;
        constexpr auto x = Layout::position;
        const Real position = Real(weights.position), twice = Real(2) * position;
        result.linear = {twice * A.at(t, x), twice * A.at(t, x + one)};
        result.quadratic = position * A.at(t, t);
    }
    return result;
}

/// A candidate's move in the world: R(theta^) v, or v where there is no heading.
template <class Layout, class Real>
Vector2<Real> world_move(const Rotation<Real>& heading, const Vector2<Real>& move) {
    if constexpr (Layout::has_heading) return rotate(heading, move);
    return move;
}

/// Writes a candidate's control into one lane.
template <class Real>
void fetch(const ControlParameters& control, int candidate, int lane, Command<Real>& command) {
    set_lane(command.turn, lane, control.candidates[candidate].turn);
    set_lane(command.move.x, lane, control.candidates[candidate].move.x);
    set_lane(command.move.y, lane, control.candidates[candidate].move.y);
}

/// The controls of the candidates numbered in each lane; where the number is negative, the control is 0.
template <class Real>
Command<Real> fetch_each(const ControlParameters& control, const Real& candidates) {
    Command<Real> command;
    for (int lane = 0; lane < lanes<Real>; ++lane)
        if (lane_of(candidates, lane) >= 0) fetch(control, static_cast<int>(lane_of(candidates, lane)), lane, command);
    return command;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
