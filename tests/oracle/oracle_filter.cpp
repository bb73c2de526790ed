// Filter of the oracle: start, prediction, joint update. Nomenclature: oracle.hpp.

#include "oracle.hpp"

#include <cmath>

namespace credence::oracle {

namespace {

/// Heading in a state (rad); 0 in the translation model.
double heading(const DeformableSettings& scenario, const Eigen::VectorXd& x) {
    return scenario.process == Process::heading ? x[0] : 0.0;
}

double squared(double value) { return value * value; }

}  // namespace

/// Belief at pose 0: robot at 0 with the initial variances (0 in the document), f_j = p_{0,j} + sigma_feat(q_{0,j})
/// eps^meas with variance (filter.measurement sigma_feat(q_{0,j}))^2, in the world frame, uncorrelated with the pose
/// and whatever its range [docs/model.md, Filter, Start].
Belief first_belief(const DeformableSettings& scenario, const World& world, const Noise& noise) {
    const int n = state_dimension(scenario);
    Belief belief{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
    if (scenario.process == Process::heading) belief.P(0, 0) = squared(scenario.noise.initial_heading);
    for (int i = row_of_position(scenario); i < pose_dimension(scenario); ++i)
        belief.P(i, i) = squared(scenario.noise.initial_position);
    for (int j = 0; j < number_of_features(scenario); ++j) {
        const double q = (world.p.col(j) - world.r).norm();
        const double sigma = measurement_sigma(scenario, q);
        const int row = row_of_feature(scenario, j);
        belief.x.segment<2>(row) = world.p.col(j) + sigma * measurement_noise(scenario, 0, j, noise);
        for (int i = row; i < row + 2; ++i) belief.P(i, i) = squared(scenario.filter.measurement * sigma);
    }
    return belief;
}

/// Mean (n) predicted for pose k from x at pose k-1: theta + omega; r + R(theta) v; f_j + t_{k-1} + d_{k,j},
/// d_{k,j} = o_{k,j} - o_{k-1,j} [docs/model.md, Filter, Predict].
Eigen::VectorXd predicted_mean(const DeformableSettings& scenario, const Eigen::VectorXd& x, const Control& control,
                               int k) {
    const Eigen::Vector2d v(control.move.x, control.move.y);
    Eigen::VectorXd x_prior = x;
    if (scenario.process == Process::heading) x_prior[0] += control.turn;
    x_prior.segment<2>(row_of_position(scenario)) += rotation(heading(scenario, x)) * v;
    for (int j = 0; j < number_of_features(scenario); ++j) {
        const Eigen::Vector2d d = local_deformation(scenario, k, j) - local_deformation(scenario, k - 1, j);
        x_prior.segment<2>(row_of_feature(scenario, j)) += translation(scenario, k - 1) + d;
    }
    return x_prior;
}

/// F (n x n) at the mean x before the prediction: the identity, except F[r, theta] = R(theta) J v in the heading model
/// [docs/model.md, Filter, Predict].
Eigen::MatrixXd prediction_jacobian(const DeformableSettings& scenario, const Eigen::VectorXd& x,
                                    const Control& control) {
    const int n = state_dimension(scenario);
    const Eigen::Vector2d v(control.move.x, control.move.y);
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n, n);
    if (scenario.process == Process::heading) F.block<2, 1>(1, 0) = rotation(x[0]) * quarter_turn() * v;
    return F;
}

/// Q (n x n) = diag(sigma_head^2, sigma_odom^2 I_2, (sigma_walk^2 + sigma_def^2) I_{2M}), each sigma times the filter's
/// factor [docs/model.md, Filter, Predict].
Eigen::MatrixXd process_noise(const DeformableSettings& scenario) {
    const int n = state_dimension(scenario);
    const NoiseSettings& noise = scenario.noise;
    const FilterSettings& factor = scenario.filter;
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n, n);
    if (scenario.process == Process::heading) Q(0, 0) = squared(factor.heading * noise.heading);
    for (int i = row_of_position(scenario); i < pose_dimension(scenario); ++i)
        Q(i, i) = squared(factor.odometry * noise.odometry);
    for (int i = pose_dimension(scenario); i < n; ++i)
        Q(i, i) = squared(factor.features * noise.walk) + squared(factor.features * noise.deformation);
    return Q;
}

/// Belief predicted for pose k from that at pose k-1: P^- = F P F' + Q [docs/model.md, Filter, Predict].
Belief predict(const DeformableSettings& scenario, const Belief& belief, const Control& control, int k) {
    const Eigen::MatrixXd F = prediction_jacobian(scenario, belief.x, control);
    Belief prior;
    prior.x = predicted_mean(scenario, belief.x, control, k);
    prior.P = F * belief.P * F.transpose() + process_noise(scenario);
    return prior;
}

/// Predicted measurement z_hat_j (2, body frame) = R(theta)' (f_j - r) [docs/model.md, Filter, Expect].
Eigen::Vector2d predicted_measurement(const DeformableSettings& scenario, const Eigen::VectorXd& x, int j) {
    const Eigen::Vector2d r = x.segment<2>(row_of_position(scenario));
    const Eigen::Vector2d f = x.segment<2>(row_of_feature(scenario, j));
    return rotation(heading(scenario, x)).transpose() * (f - r);
}

/// H_j (2 x n) = [-J z_hat_j, -R', R'] at (theta, r, f_j); no theta in the translation model
/// [docs/model.md, Filter, Expect].
Eigen::MatrixXd measurement_rows(const DeformableSettings& scenario, const Eigen::VectorXd& x, int j) {
    const Eigen::Matrix2d R = rotation(heading(scenario, x));
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, state_dimension(scenario));
    if (scenario.process == Process::heading)
        H.block<2, 1>(0, 0) = -quarter_turn() * predicted_measurement(scenario, x, j);
    H.block<2, 2>(0, row_of_position(scenario)) = -R.transpose();
    H.block<2, 2>(0, row_of_feature(scenario, j)) = R.transpose();
    return H;
}

/// Predicted construction measurement (2, world frame) = f_b - f_a [docs/model.md, Filter, Edges].
Eigen::Vector2d predicted_edge(const DeformableSettings& scenario, const Eigen::VectorXd& x, const Edge& edge) {
    return x.segment<2>(row_of_feature(scenario, edge.to)) - x.segment<2>(row_of_feature(scenario, edge.from));
}

/// H (2 x n) of an edge = [-I_2, I_2] at (f_a, f_b) [docs/model.md, Filter, Edges].
Eigen::MatrixXd edge_rows(const DeformableSettings& scenario, const Edge& edge) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, state_dimension(scenario));
    H.block<2, 2>(0, row_of_feature(scenario, edge.from)) = -Eigen::Matrix2d::Identity();
    H.block<2, 2>(0, row_of_feature(scenario, edge.to)) = Eigen::Matrix2d::Identity();
    return H;
}

/// Joint predicted measurement at the mean x: the seen features (M flags), each with the sigma that the filter believes
/// (M, length), then all edges with sigma_def times filter.edges [docs/model.md, Filter].
Prediction predicted_measurements(const DeformableSettings& scenario, const Eigen::VectorXd& x,
                                  const std::vector<bool>& seen, const Eigen::VectorXd& sigma) {
    const std::vector<Edge> edges = graph(scenario);
    int m = 2 * static_cast<int>(edges.size());
    for (const bool feature_seen : seen) m += feature_seen ? 2 : 0;
    Prediction prediction{Eigen::VectorXd(m), Eigen::MatrixXd(m, state_dimension(scenario)), Eigen::VectorXd(m)};
    int row = 0;
    for (int j = 0; j < number_of_features(scenario); ++j) {
        if (!seen[static_cast<std::size_t>(j)]) continue;
        prediction.z_hat.segment<2>(row) = predicted_measurement(scenario, x, j);
        prediction.H.middleRows<2>(row) = measurement_rows(scenario, x, j);
        prediction.N.segment<2>(row).setConstant(squared(sigma[j]));
        row += 2;
    }
    for (const Edge& edge : edges) {
        prediction.z_hat.segment<2>(row) = predicted_edge(scenario, x, edge);
        prediction.H.middleRows<2>(row) = edge_rows(scenario, edge);
        prediction.N.segment<2>(row).setConstant(squared(scenario.filter.edges * scenario.noise.deformation));
        row += 2;
    }
    return prediction;
}

/// S = H P^- H' + N, K = P^- H' S^-1, P = P^- - K S K'; needs at least one row [docs/model.md, Filter, Update].
Correction correct(const Eigen::MatrixXd& P_prior, const Prediction& prediction) {
    const Eigen::MatrixXd& H = prediction.H;
    Correction correction;
    correction.S = H * P_prior * H.transpose();
    correction.S.diagonal() += prediction.N;
    // S K' = H P^-, as S and P^- are symmetric.
    correction.K = correction.S.ldlt().solve(H * P_prior).transpose();
    correction.P = P_prior - correction.K * correction.S * correction.K.transpose();
    return correction;
}

}  // namespace credence::oracle
