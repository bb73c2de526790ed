#pragma once
// The poses of a trajectory of EKF-SLAM as Eigen matrices.

#include <credence/detail/deformable_settings.hpp>
#include <credence/detail/trajectory.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <string>
#include <vector>

namespace credence {

/// One pose of a trial: the variables of that pose. n state dimension, M features, m rows, C candidates.
struct TrajectoryStep {
    Eigen::VectorXd truth, mean, predicted_mean;              ///< [n]
    Eigen::MatrixXd covariance, predicted_covariance;         ///< [n, n]
    Control control;
    std::vector<bool> seen;                                   ///< [M]
    Eigen::VectorXd measurement_sigma;                        ///< [M]
    Eigen::MatrixX2d measurement;                             ///< [M, 2]
    Eigen::VectorXd innovation;                               ///< [m]
    Eigen::MatrixXd innovation_covariance;                    ///< [m, m]
    double nees = 0, nis = 0, trace_P = 0;
    int rows = 0;
    std::vector<double> candidate_cost;                       ///< [C]
};

inline const TrajectoryVariable* find_variable(const Trajectory& trajectory, const std::string& name) {
    for (const TrajectoryVariable& variable : trajectory.variables)
        if (variable.name == name) return &variable;
    return nullptr;
}

/// The values of a variable at a pose, as rows of `columns` numbers; empty where there is none of that name.
inline Eigen::MatrixXd values_at(const Trajectory& trajectory, const std::string& name, int pose,
                                 Eigen::Index columns = 1) {
    const TrajectoryVariable* variable = find_variable(trajectory, name);
    if (variable == nullptr) return {};
    const auto size = static_cast<Eigen::Index>(variable->values.size()) / trajectory.scenario.poses;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(variable->values.data() + pose * size, size / columns, columns);
}

inline std::vector<TrajectoryStep> steps_of(const Trajectory& trajectory) {
    std::vector<TrajectoryStep> steps(static_cast<std::size_t>(trajectory.scenario.poses));
    const auto n = static_cast<Eigen::Index>(trajectory.scenario.components.size());
    for (int k = 0; k < trajectory.scenario.poses; ++k) {
        TrajectoryStep& step = steps[static_cast<std::size_t>(k)];
        const auto at = [&](const char* name, Eigen::Index columns = 1) {
            return values_at(trajectory, name, k, columns);
        };
        step.truth = at("truth"), step.mean = at("mean"), step.predicted_mean = at("predicted_mean");
        step.covariance = at("covariance", n), step.predicted_covariance = at("predicted_covariance", n);
        const Eigen::MatrixXd move = at("control_move");
        step.control = {at("control_turn")(0), {move(0), move(1)}};
        const Eigen::MatrixXd seen = at("seen");
        for (Eigen::Index j = 0; j < seen.size(); ++j) step.seen.push_back(seen(j) == 1);
        step.measurement_sigma = at("measurement_sigma");
        step.measurement = at("measurement", 2);
        step.innovation = at("innovation");
        step.innovation_covariance = at("innovation_covariance", std::max<Eigen::Index>(step.innovation.size(), 1));
        step.nees = at("nees")(0), step.nis = at("nis")(0), step.trace_P = at("trace_P")(0);
        step.rows = static_cast<int>(at("rows")(0));
        const Eigen::MatrixXd cost = at("candidate_cost");
        step.candidate_cost.assign(cost.data(), cost.data() + cost.size());
    }
    return steps;
}

}  // namespace credence
