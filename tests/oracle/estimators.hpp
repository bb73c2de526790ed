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
std::vector<Estimate> estimates(const DeformableSettings& scenario, Estimator estimator, const test::Run& run);

/// T(x): from the Euclidean error to the right-invariant one, I with the column of theta (1; -J r; -J f_j).
Eigen::MatrixXd chart(const Eigen::VectorXd& x);
/// exp(xi) x
Eigen::VectorXd moved(const Eigen::VectorXd& x, const Eigen::VectorXd& xi);

}  // namespace credence::oracle
