#pragma once
// The truth: features that drift and deform, and the robot's motion [docs/model.md, Truth].
//
//   c   feature centre, p  deformed feature: what the sensor sees and the filter estimates; o  known local deformation
//   r   robot position, theta  heading; t_k  known translation of the features from pose k to k + 1
//   All in the world frame, in length units and radians.

#include "slam/pose_draws.hpp"

namespace credence {

/// The parameters of the truth, as plain numbers. The Problem owns the pointers' targets.
struct WorldParameters {
    int poses = 0, features = 0, edges = 0;
    const Point* first_position = nullptr;  ///< [M] f_0
    const Point* translation = nullptr;     ///< [K - 1] t_k
    const Point* sway = nullptr;            ///< [K, M] o_{k,j}
    double sigma_heading = 0, sigma_odometry = 0, sigma_walk = 0, sigma_deformation = 0;
    double sigma_initial_heading = 0, sigma_initial_position = 0, sigma_odometry_bias = 0;
    Placement placement = Placement::given;
    double extent = 0, radius_min = 0, radius_max = 0;  ///< of the box, of the ring
    Deformation deformation = Deformation::jitter;
    double truncate = 0;                    ///< infinity: never

    const Point& sway_at(int k, int j) const { return sway[k * features + j]; }
};

inline namespace CREDENCE_TARGET {

/// The noise that is drawn at a pose of this world.
template <class Layout, class Real>
using WorldDraws = PoseDraws<Layout, Real, Source::walk, Source::deformation, Source::measurement>;

template <class Real, int feature_capacity>
struct Truth {
    Real heading{};
    Rotation<Real> rotation;                     ///< R(heading); heading model only
    Vector2<Real> position{};
    Vector2<Real> odometry_bias{};               ///< of a step, body frame; where the world has one
    Vector2<Real> centre[feature_capacity];
    Vector2<Real> feature[feature_capacity];
};

template <class Real>
Vector2<Real> broadcast(const Point& point) {
    return {Real(point.x), Real(point.y)};
}

/// p_{k,j} = c_{k,j} + o_{k,j} + sigma_def eps^def_{k,j}; where the deformation walks, the draw is included in c.
/// `draws` are pose k's.
template <class Layout, class Real, int capacity>
void deform_features(Truth<Real, capacity>& truth, const WorldParameters& world, const Layout& layout, int k,
                     const WorldDraws<Layout, Real>& draws) {
    const Vector2<Real>* deformation = draws.template of_features<Source::deformation>();
    each(zero, layout.features(), [&](auto j) {
        truth.feature[j] = truth.centre[j] + broadcast<Real>(world.sway_at(k, j));
        if (world.deformation == Deformation::jitter)
            truth.feature[j] = add_scaled(truth.feature[j], Real(world.sigma_deformation), deformation[j]);
    });
}

/// f_0 of feature j: its own, or uniform in a box or ring about the first one's.
template <class Real, class Noise>
Vector2<Real> first_place(const WorldParameters& world, int j, const Noise& noise) {
    if (world.placement == Placement::given) return broadcast<Real>(world.first_position[j]);
    const Vector2<Real> middle = broadcast<Real>(world.first_position[0]);
    const Real u = noise.uniform(Source::placement, 0, 2 * j), v = noise.uniform(Source::placement, 0, 2 * j + 1);
    if (world.placement == Placement::box)
        return add_scaled(middle, Real(world.extent), Vector2<Real>{u - Real(0.5), v - Real(0.5)});
    const double inner = world.radius_min * world.radius_min, outer = world.radius_max * world.radius_max;
    const Rotation<Real> direction = rotation_of_turns(v);
    return add_scaled(middle, sqrt(fma(u, Real(outer - inner), Real(inner))),
                      Vector2<Real>{direction.cosine, direction.sine});
}

/// The truth at pose 0: features about f_0, the robot at 0 (or drawn about it).
template <class Layout, class Real, int capacity, class Noise>
void start_truth(Truth<Real, capacity>& truth, const WorldParameters& world, const Layout& layout,
                 const WorldDraws<Layout, Real>& draws, const Noise& noise) {
    truth.heading = Real(0);
    if constexpr (Layout::has_heading) truth.heading = Real(world.sigma_initial_heading) * draws.heading();
    truth.rotation = rotation(truth.heading);
    truth.position = add_scaled(Vector2<Real>{}, Real(world.sigma_initial_position), draws.position());
    if (world.sigma_odometry_bias > 0)
        truth.odometry_bias = add_scaled(Vector2<Real>{}, Real(world.sigma_odometry_bias),
                                         noise.normal(Source::odometry_bias, 0, 0));
    each(zero, layout.features(), [&](auto j) { truth.centre[j] = first_place<Real>(world, j, noise); });
    deform_features(truth, world, layout, 0, draws);
}

/// Features from pose k - 1 to k: c_k = c_{k-1} + t_{k-1} + sigma_walk eps^walk_{k-1} (+ sigma_def eps^def_k where
/// deformation walks).
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void move_features(Truth<Real, capacity>& truth, const WorldParameters& world, const Layout& layout,
                                 int k, const WorldDraws<Layout, Real>& draws) {
    const Vector2<Real>* walk = draws.template of_features<Source::walk>();
    const Vector2<Real>* deformation = draws.template of_features<Source::deformation>();
    each(zero, layout.features(), [&](auto j) {
        const Vector2<Real> centre = truth.centre[j] + broadcast<Real>(world.translation[k - 1]);
        truth.centre[j] = add_scaled(centre, Real(world.sigma_walk), walk[j]);
        if (world.deformation == Deformation::walk)
            truth.centre[j] = add_scaled(truth.centre[j], Real(world.sigma_deformation), deformation[j]);
    });
    deform_features(truth, world, layout, k, draws);
}

/// A control of one step: turn in radians; move in length units, body frame (heading model) or world frame.
template <class Real>
struct Command {
    Real turn{};
    Vector2<Real> move{};
};

/// Robot from pose k - 1 to k: theta_k = theta_{k-1} + omega + sigma_head eps, r_k = r_{k-1} + R(theta_{k-1}) (v + b) +
/// sigma_odom eps, b the odometry's bias.
template <class Layout, class Real, int capacity>
CREDENCE_FLAT void move_robot(Truth<Real, capacity>& truth, const WorldParameters& world, const Command<Real>& command,
                              const WorldDraws<Layout, Real>& draws) {
    Vector2<Real> move = command.move;
    if (world.sigma_odometry_bias > 0) move = move + truth.odometry_bias;
    if constexpr (Layout::has_heading) {
        move = rotate(truth.rotation, move);
        truth.heading = fma(Real(world.sigma_heading), draws.heading(), truth.heading + command.turn);
        truth.rotation = rotation(truth.heading);
    }
    truth.position = add_scaled(truth.position + move, Real(world.sigma_odometry), draws.position());
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
