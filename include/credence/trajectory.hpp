#pragma once
// Module worlds: the trajectory of a single trial with all its quantities, as Eigen matrices. Replay writes it; tests
// compare it.

#include <credence/recorded_noise.hpp>
#include <credence/deformable_settings.hpp>

#include <Eigen/Dense>

#include <cstdint>
#include <string>
#include <vector>

namespace credence {

class Problem;

/// One pose of a trial. What only exists after pose 0 is empty there.
/// n state dimension, M features, m rows of the largest possible measurement (2 M + 2 edges), C candidates.
struct TrajectoryStep {
    Eigen::VectorXd truth;                  ///< [n] true state
    Eigen::VectorXd mean;                   ///< [n] after the update
    Eigen::MatrixXd covariance;             ///< [n, n] after the update, as reported (times filter.covariance)
    Eigen::VectorXd predicted_mean;         ///< [n]
    Eigen::MatrixXd predicted_covariance;   ///< [n, n], as the filter holds it
    Control control;                        ///< the control on the way to this pose
    std::vector<bool> seen;                 ///< [M]
    Eigen::VectorXd measurement_sigma;      ///< [M] true standard deviation
    Eigen::MatrixX2d measurement;           ///< [M, 2] body frame, NaN where not seen
    Eigen::VectorXd innovation;             ///< [m] features (body frame) then edges, NaN where not observed
    Eigen::MatrixXd innovation_covariance;  ///< [m, m], NaN where not observed
    double nees = 0, nis = 0, trace_P = 0;
    int rows = 0;
    std::vector<double> candidate_cost;     ///< [C] predicted trace(P) of each candidate; planned only
};

struct Trajectory {
    DeformableSettings scenario;                      ///< resolved
    Arm arm;
    std::string source;                     ///< where its noise came from: `root seed 1, trial 17`, `noise record`
    std::vector<double> columns;            ///< [column_count], as in the results file
    std::vector<TrajectoryStep> steps;      ///< [K]
    std::vector<Control> candidates;        ///< [C]; planned only

    /// Innovations are kept up to this many rows; beyond, a single trial would take gigabytes.
    static constexpr int largest_innovation = 512;
};

/// Runs one trial of one arm again, on the study's draws. The same bits as the engine's.
Trajectory replay_trial(const Problem& problem, const Arm& arm, std::uint64_t root_seed, std::int64_t trial);

/// Throws InputError where the noise record is too short, too narrow or lacks draws of the scenario. `file` names it.
void check_covers(const NoiseRecord& record, const DeformableSettings& scenario, const std::string& file);

/// Runs one arm on recorded noise, which must cover the scenario.
Trajectory replay_record(const Problem& problem, const Arm& arm, const NoiseRecord& record);

}  // namespace credence
