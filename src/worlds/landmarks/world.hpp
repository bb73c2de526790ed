#pragma once
// The world of landmarks that stand about a loop [docs/estimators.md]. The robot follows its loop to the letter;
// the noise is on what its filter is given of the motion, so that where each landmark comes into sight is known before
// any trial.
//
//   r  robot position, theta  heading, f_j  landmark; omega, v  turn and move (body frame) from one pose to the next
//   All in the world frame, in length units and radians.

#include "slam/sensor.hpp"

namespace credence {

/// A pose of the robot on its loop.
struct LoopPose {
    double heading = 0;
    Point position;
};

/// What the truth is made of, as plain numbers. The pointers are owned by the LandmarkProblem.
struct LandmarkParameters {
    const LoopPose* pose = nullptr;      ///< [K] true
    const Control* motion = nullptr;     ///< [K - 1] true, from pose k to k + 1
    const Point* landmark = nullptr;     ///< [M] f_j
    const int* first_pose = nullptr;     ///< [M] where landmark j is first in sight; K where never
    double sigma_heading = 0, sigma_odometry = 0;
    double sigma_prior = 0;              ///< of the belief of a landmark that was not seen yet
};

inline namespace CREDENCE_TARGET {

/// What is drawn at a pose of this world.
template <class Layout, class Real>
using LandmarkDraws = PoseDraws<Layout, Real, Source::measurement>;

/// The true robot at pose k.
template <class Real, int capacity>
void stand_at(Truth<Real, capacity>& truth, const LandmarkParameters& world, int k) {
    truth.heading = Real(world.pose[k].heading);
    truth.rotation = rotation(truth.heading);
    truth.position = broadcast<Real>(world.pose[k].position);
}

/// The truth at pose 0.
template <class Real, int capacity>
void start_truth(Truth<Real, capacity>& truth, const LandmarkParameters& world, int features) {
    stand_at(truth, world, 0);
    for (int j = 0; j < features; ++j) truth.feature[j] = truth.centre[j] = broadcast<Real>(world.landmark[j]);
}

/// What the filter is given of the motion to pose k: omega - sigma_head eps, v - sigma_odom eps (body frame).
template <class Layout, class Real>
CREDENCE_FLAT Command<Real> reported_motion(const LandmarkParameters& world, int k,
                                        const LandmarkDraws<Layout, Real>& draws) {
    const Control& motion = world.motion[k - 1];
    return {fnma(Real(world.sigma_heading), draws.heading(), Real(motion.turn)),
            add_scaled(broadcast<Real>(motion.move), Real(-world.sigma_odometry), draws.position())};
}

/// What is believed of landmark j before it is seen: a place drawn about the true one, world frame.
template <class Real, int capacity, class Noise>
Sighting<Real> drawn_prior(const Truth<Real, capacity>& truth, const LandmarkParameters& world, int j,
                           const Noise& noise) {
    const Real sigma = Real(world.sigma_prior);
    return {Mask<Real>{}, add_scaled(truth.feature[j], sigma, noise.normal(Source::landmark_prior, 0, j)), sigma};
}

/// Sets aside what pose k shows for the first time: a landmark that is not known yet has no place in the update.
/// Returns how many there are.
template <class Real>
int set_aside_first_sights(const LandmarkParameters& world, int features, int k, Sighting<Real>* sightings) {
    int count = 0;
    for (int j = 0; j < features; ++j) {
        if (world.first_pose[j] != k) continue;
        sightings[j].seen = negated(all_lanes<Real>());
        ++count;
    }
    return count;
}

}  // namespace CREDENCE_TARGET
}  // namespace credence
