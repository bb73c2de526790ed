#pragma once
// The oracle of the loop among landmarks: one trial with dense matrices, a state that grows as landmarks come into sight,
// and every estimator as its paper writes it.

#include "estimators.hpp"

#include "worlds/explore/settings.hpp"

namespace credence::oracle {

/// What an estimator holds of theta, r and the landmarks seen so far, in the order in which they were.
struct LandmarkStep {
    std::vector<int> landmarks;
    Eigen::VectorXd truth;           ///< of the same
    Estimate estimate;
    double nis = 0;                  ///< of the landmarks that were known; 0 at pose 0
    int rows = 0;
    Eigen::VectorXd last_move;       ///< what the last pass of the iterated update moved
};

/// One trial along the circle of control.path, by pose; the motion is known, and what is reported of it is not.
std::vector<LandmarkStep> landmark_trial(const ExploreSettings& scenario, Estimator estimator, const Noise& noise);

}  // namespace credence::oracle
