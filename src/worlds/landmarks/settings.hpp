#pragma once
// The scenario of the world of landmarks [docs/estimators.md]. One plain struct per concern; the defaults are the
// classical loop on which the extended Kalman filter is known to lose its consistency.
//
// Targets: lengths in `length_unit`, angles in radians; sigma is a standard deviation.

#include <credence/detail/deformable_settings.hpp>

#include <string>
#include <vector>

namespace credence {

/// The loop: a regular polygon, walked counterclockwise from (0, 0), at first along x.
struct LoopSettings {
    int sides = 60;
    double step = 1;                     ///< d, length of a side
};

/// M landmarks about the polygon's centre, at equal angles, alternately farther out and nearer than its corners.
struct LandmarkPlacement {
    int count = 20;
    double offset = 1;                   ///< how much farther, how much nearer
    double prior = 10;                   ///< sigma of what is believed of one that was not seen yet
};

struct LandmarkSensorSettings {
    double range_max = 5;                ///< farthest range seen, included; may be infinite
    double sigma = 0.3;                  ///< of each axis of a relative position, body frame
};

/// The noise on the motion that the filter is given.
struct LandmarkNoiseSettings {
    double heading = 0.05;
    double odometry = 0.1;
};

struct LandmarkSettings {
    std::string name = "scenario";
    std::string title;
    std::string length_unit = "m";
    int poses = 601;                     ///< K, the first included
    BudgetSettings budget;
    LoopSettings loop;
    LandmarkPlacement landmarks;
    LandmarkSensorSettings sensor;
    LandmarkNoiseSettings noise;
    std::vector<Estimator> estimators{Estimator::ekf, Estimator::ideal, Estimator::fej, Estimator::riekf,
                                      Estimator::iekf};
};

/// Throws InputError naming the key where a value makes S or P singular, or an estimator has no heading.
void validate(const LandmarkSettings& scenario);

}  // namespace credence
