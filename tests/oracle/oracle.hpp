#pragma once
// The oracle: the whole model once more, plain and slow, with Eigen's dense matrices and std:: functions, written from
// model.md alone. Tests compare the production code with it; nothing here is shared with that code but the Scenario
// and the Source enumeration.
//
// Nomenclature (lengths in the scenario's length unit, angles in rad; world frame unless said otherwise):
//   K, M, n    number of poses (the first included), of features, of states; indices are k, j, and i
//   theta, r   robot's heading and position (2)
//   c, o, p    feature's centre, known local deformation, deformed position (2 each); p is what is seen and estimated
//   x, P       state's mean (n) and covariance (n x n); x = [theta, r, f_0, ...] (heading), [r, f_0, ...] (translation)
//   F, Q       Jacobian of the prediction and covariance of its noise (n x n)
//   q          range from the robot to a feature
//   z, nu      measurement and innovation (m): body frame for features, world frame for edges
//   H, N       Jacobian of the measurements (m x n), their variances (m, the diagonal of the document's N)
//   S, K       innovation's covariance (m x m), gain (n x m); K in formulas of the update only
//   R, J       rotation by theta, and by a quarter turn (2 x 2)
//   d, delta   step and turn of the features and the robot; phi_k = delta/2 + k delta
// Stacked measurements hold the seen features by rising j, two rows each, and then every edge in graph order.

#include <credence/detail/draws.hpp>
#include <credence/detail/deformable_settings.hpp>

#include <Eigen/Dense>

#include <functional>
#include <vector>

namespace credence::oracle {

/// The oracle's random numbers: pure functions of (source, pose, index), already truncated where that is wanted.
struct Noise {
    std::function<Eigen::Vector2d(Source, int pose, int index)> normal;  ///< two independent standard-normal draws
    std::function<double(Source, int pose, int index)> uniform;          ///< in [0, 1)
};

/// What happened on the way to one pose and at it. At pose 0 only truth, mean, covariance and trace_P are set.
struct Step {
    Eigen::VectorXd truth, prior_mean, mean;              ///< n; headings are never wrapped
    Eigen::MatrixXd prior_covariance, covariance;         ///< n x n, not scaled by filter.covariance
    Eigen::VectorXd innovation;                           ///< m, z - z_hat
    Eigen::MatrixXd innovation_covariance;                ///< m x m
    Control control;                                      ///< that led from the pose before to this one
    std::vector<bool> seen;                               ///< M
    double nees = 0;                                      ///< whole state, with the reported covariance
    double nis = 0;                                       ///< 0 if there are no rows
    double trace_P = 0;                                   ///< of the reported covariance; adds rad^2 to length^2
    int rows = 0;                                         ///< m
    Eigen::VectorXd candidate_cost;                       ///< per candidate, of unreported P, summed over the horizon
    double condition_of_S = 1;                            ///< 2-norm; 1 if there are no rows
};

/// One trial, its columns and its series [docs/model.md, Reported per trial].
struct Trial {
    std::vector<Step> steps;   ///< K, by pose
    double trace_P = 0;        ///< of the last pose, reported covariance
    int unseen = 0;            ///< pairs of pose k >= 1 and feature that gave no rows
    double pose_error = 0;     ///< sum over all k of the squared error of the pose, heading included and not wrapped
    double nees_ratio = 0;     ///< mean over k >= 1 of NEES/n; NaN for K = 1
    double nis_ratio = 0;      ///< sum of NIS / sum of m; NaN if there never was a row
    double log_score = 0;      ///< mean over k >= 1 of (n log 2 pi + log det P + NEES)/2, reported covariance
    double path_length = 0;    ///< of the true robot
};

/// Runs one trial from pose 0 to K-1. Makes no check of the scenario and knows no status: a trial that breaks down
/// goes on with what arithmetic gives.
Trial run(const DeformableSettings& scenario, Controller controller, const Noise& noise);

// Sizes and places in the state ---------------------------------------------------------------------------------------

int number_of_features(const DeformableSettings& scenario);                       ///< M
int pose_dimension(const DeformableSettings& scenario);                      ///< 3 (heading) or 2 (translation)
int state_dimension(const DeformableSettings& scenario);                     ///< n = pose_dimension + 2 M
int row_of_position(const DeformableSettings& scenario);                     ///< where r starts in x
int row_of_feature(const DeformableSettings& scenario, int j);               ///< where f_j starts in x
std::vector<Edge> graph(const DeformableSettings& scenario);                 ///< edges in graph order
Eigen::Matrix2d rotation(double theta);                            ///< R(theta)
Eigen::Matrix2d quarter_turn();                                    ///< J

// World [docs/model.md, Truth] ----------------------------------------------------------------------------------------

/// True state of the world at one pose; c and p are 2 x M. theta stays 0 in the translation model.
struct World {
    double theta = 0;
    Eigen::Vector2d bias = Eigen::Vector2d::Zero();  ///< of the odometry
    Eigen::Vector2d r;
    Eigen::Matrix2Xd c, p;
};

/// T_k, of every feature from pose k to k+1.
Eigen::Vector2d translation(const DeformableSettings& scenario, int k);
Eigen::Vector2d local_deformation(const DeformableSettings& scenario, int k, int j);  ///< o_{k,j}
World first_world(const DeformableSettings& scenario, const Noise& noise);
World next_world(const DeformableSettings& scenario, const World& world, const Control& control, int k,
                 const Noise& noise);
Eigen::VectorXd true_state(const DeformableSettings& scenario, const World& world);   ///< n, ordered as the filter's x
bool in_range(const DeformableSettings& scenario, double q);                 ///< r_min <= q <= r_max
double measurement_sigma(const DeformableSettings& scenario, double q);      ///< true sigma_feat(q), length
/// Over sigma.
Eigen::Vector2d measurement_noise(const DeformableSettings& scenario, int k, int j, const Noise& noise);
Eigen::Vector2d measured_feature(const DeformableSettings& scenario, const World& world, int k, int j,
                                 const Noise& noise);
Eigen::Vector2d measured_edge(const DeformableSettings& scenario, const World& world, int k, int e, const Noise& noise);

// Filter [docs/model.md, Filter] --------------------------------------------------------------------------------------

struct Belief {
    Eigen::VectorXd x;
    Eigen::MatrixXd P;
};

/// Stacked measurements as the filter predicts them at a mean: z_hat (m), H (m x n), N (m, variances).
struct Prediction {
    Eigen::VectorXd z_hat;
    Eigen::MatrixXd H;
    Eigen::VectorXd N;
};

/// Gain (n x m), innovation covariance (m x m) and covariance after an update (n x n).
struct Correction {
    Eigen::MatrixXd K, S, P;
};

Belief first_belief(const DeformableSettings& scenario, const World& world, const Noise& noise);
Eigen::VectorXd predicted_mean(const DeformableSettings& scenario, const Eigen::VectorXd& x, const Control& control,
                               int k);
Eigen::MatrixXd prediction_jacobian(const DeformableSettings& scenario, const Eigen::VectorXd& x,
                                    const Control& control);
Eigen::MatrixXd process_noise(const DeformableSettings& scenario);           ///< Q
Belief predict(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k);
Eigen::Vector2d predicted_measurement(const DeformableSettings& scenario, const Eigen::VectorXd& x, int j);
Eigen::MatrixXd measurement_rows(const DeformableSettings& scenario, const Eigen::VectorXd& x, int j);
Eigen::Vector2d predicted_edge(const DeformableSettings& scenario, const Eigen::VectorXd& x, const Edge& edge);
Eigen::MatrixXd edge_rows(const DeformableSettings& scenario, const Edge& edge);
Prediction predicted_measurements(const DeformableSettings& scenario, const Eigen::VectorXd& x,
                                  const std::vector<bool>& seen, const Eigen::VectorXd& sigma);
Correction correct(const Eigen::MatrixXd& P_prior, const Prediction& prediction);

// Controllers [docs/model.md, Controllers] ----------------------------------------------------------------------------

Path path_of_robot(const DeformableSettings& scenario);                      ///< control.path, or the features' own
Control fixed_control(const DeformableSettings& scenario, int k);            ///< from pose k to k+1
std::vector<Control> candidates(const DeformableSettings& scenario);         ///< in the order of model.md
double cost_of(const DeformableSettings& scenario, const Eigen::MatrixXd& P);  ///< planner.criterion
double candidate_cost(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k);
double cost_ahead(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k, int steps);
int greedy_choice(const DeformableSettings& scenario, const Eigen::VectorXd& cost);  ///< index of the chosen candidate
Control baseline_control(const DeformableSettings& scenario, Controller controller, const Belief& belief, int k,
                         const Noise& noise);                      ///< of a controller that does not plan

}  // namespace credence::oracle
