#pragma once
// The scenario of the world `explore` [docs/explore.md]: that of the deformable world with features that stand still,
// and what is new: walls, a view, a map that is discovered, and a grid of what has been in view.
//
// Lengths in `length_unit`, angles in radians.

#include <credence/detail/deformable_settings.hpp>

#include <numbers>
#include <string>
#include <vector>

namespace credence {

/// A wall: a segment in the world frame.
struct WallSegment {
    Point from, to;
};

/// When a landmark enters the state: at its first sight; at the start, with a prior that its first sight replaces; or
/// at the start, measured whatever its range, as in the deformable world.
enum class LandmarkMap { none, prior, known };

/// What the noise of a motion is on: the robot's motion itself, or what the filter is given of it.
enum class MotionNoise { motion, report };

/// frontier: towards the nearest cell that was not in view; informed: greedy, on the true state. In the order of
/// explorer_names.
enum class Explorer { fixed, random, frontier, greedy, horizon, informed };

struct ExploreSettings : DeformableSettings {
    std::vector<WallSegment> walls;
    double radius = 0.2;                          ///< of the robot: no nearer does it come to a wall
    double view = 2 * std::numbers::pi;           ///< the sensor's full angle
    LandmarkMap map = LandmarkMap::none;
    double prior = 10;                            ///< sigma of a landmark before it is seen, where there is a prior
    MotionNoise motion_noise = MotionNoise::motion;
    std::vector<Point> box{{-10, -10}, {10, 10}}; ///< two opposite corners of the grid
    double cell = 1;                              ///< side of a cell
    double coverage = 0;                          ///< what a cell that comes into view is worth, in units of the cost
    std::vector<Explorer> explorers{Explorer::fixed, Explorer::greedy};

    ExploreSettings();
};

inline constexpr std::size_t largest_wall_count = 256;
inline constexpr int largest_cell_count = 1 << 16;

/// Whether a controller weighs the planner's candidates.
constexpr bool plans(Explorer explorer) { return explorer >= Explorer::greedy; }

/// An arm: a controller and an estimator.
struct ExploreArm {
    Explorer controller = Explorer::fixed;
    Estimator estimator = Estimator::ekf;
    int planner = -1;  ///< as of Arm
};
std::vector<ExploreArm> arms_of(const ExploreSettings& settings);

/// The settings with the planner's grid and the estimators filled in. Throws InputError where keys contradict each
/// other.
ExploreSettings resolved(const ExploreSettings& settings);

const std::vector<std::string>& explorer_names();

}  // namespace credence
