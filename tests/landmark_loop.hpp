#pragma once
// The loop among landmarks of docs/estimators.md, with any numbers, as a scenario of the world `explore`.

#include "slam/trial/problem.hpp"
#include "worlds/explore/settings.hpp"

namespace credence::test {

/// A regular polygon that is walked counterclockwise from (0, 0), and M landmarks about its centre, at equal angles,
/// alternately farther out and nearer than its corners by the offset.
struct LoopShape {
    int sides = 60;
    double step = 1;
    int landmarks = 20;
    double offset = 1;
};

/// Not resolved yet. All but the shape is the classical loop, walked `poses` - 1 steps.
inline ExploreSettings landmark_loop(int poses, const LoopShape& shape = {}) {
    ExploreSettings settings;
    settings.name = "landmarks";
    settings.poses = poses;
    settings.fixed_path = FixedPath::circle;
    settings.features.step = shape.step;
    settings.features.turn = 2 * std::numbers::pi / shape.sides;
    const double half_turn = settings.features.turn / 2;
    const double radius = shape.step / (2 * rotation(half_turn).sine);
    const Point centre = polar(radius, std::numbers::pi / 2 + half_turn);
    settings.features.placement = Placement::given;
    settings.features.positions.clear();
    for (int j = 0; j < shape.landmarks; ++j) {
        const Point arm = polar(radius + (j % 2 == 0 ? shape.offset : -shape.offset),
                                2 * half_turn + 2 * std::numbers::pi * j / shape.landmarks);
        settings.features.positions.push_back({centre.x + arm.x, centre.y + arm.y});
    }
    settings.map = LandmarkMap::prior;
    settings.motion_noise = MotionNoise::report;
    settings.sensor.sigma = 0.3;
    settings.noise.heading = 0.05;
    settings.noise.odometry = 0.1;
    settings.cell = 20;
    settings.explorers = {Explorer::fixed};
    settings.arms.estimators = {Estimator::ekf, Estimator::ideal, Estimator::fej, Estimator::riekf, Estimator::iekf};
    return settings;
}

}  // namespace credence::test
