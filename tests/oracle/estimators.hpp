#pragma once
// The oracle of the estimators beside the Kalman filter: each as its paper writes it, with dense matrices and the joint
// update, on what a trial measured. Letters as in oracle.hpp.

#include "../support.hpp"

namespace credence::oracle {

struct Estimate {
    Eigen::VectorXd mean;        ///< n
    Eigen::MatrixXd covariance;  ///< n x n, of the Euclidean error
};

/// What an estimator of the heading model makes of the trial `run`, at every pose. It starts from the run's first
/// estimate and takes from each step the control, the sightings, the edges, and for `ideal` the truth.
std::vector<Estimate> estimates(const Scenario& scenario, Estimator estimator, const test::Run& run);

}  // namespace credence::oracle
