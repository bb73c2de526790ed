// One trial of the oracle, from pose 0 to K-1, and its columns and series. Nomenclature: oracle.hpp.

#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace credence::oracle {

namespace {

/// NEES = e' (filter.covariance P)^-1 e of the whole state, e's heading wrapped to [-pi, pi]
/// [docs/model.md, Reported per trial].
double normalized_error(const DeformableSettings& scenario, const Step& step) {
    Eigen::VectorXd e = step.mean - step.truth;
    if (scenario.process == Process::heading) e[0] = std::remainder(e[0], 2 * std::numbers::pi);
    const Eigen::MatrixXd reported = scenario.filter.covariance * step.covariance;
    return e.dot(reported.ldlt().solve(e));
}

/// Ratio of the largest to the smallest eigenvalue of a symmetric matrix.
double condition(const Eigen::MatrixXd& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff() / solver.eigenvalues().minCoeff();
}

/// Control from pose k-1 to k, with the candidates' costs when planned [docs/model.md, Controllers]. A horizon ends at
/// the last pose.
void choose_control(const DeformableSettings& scenario, Controller controller, const Belief& belief, int k,
                    const Noise& noise, Step& step) {
    if (controller != Controller::greedy && controller != Controller::horizon) {
        step.control = baseline_control(scenario, controller, belief, k, noise);
        return;
    }
    const std::vector<Control> list = candidates(scenario);
    step.candidate_cost.resize(static_cast<Eigen::Index>(list.size()));
    const int steps = controller == Controller::greedy ? 1 : std::min(*scenario.planner.horizon, scenario.poses - k);
    for (std::size_t i = 0; i < list.size(); ++i)
        step.candidate_cost[static_cast<Eigen::Index>(i)] = cost_ahead(scenario, belief, list[i], k, steps);
    step.control = list[static_cast<std::size_t>(greedy_choice(scenario, step.candidate_cost))];
}

/// Measurements z (m) at pose k: the seen features, then all edges [docs/model.md, Filter, See and Edges].
Eigen::VectorXd measurements(const DeformableSettings& scenario, const World& world, int k, const Step& step,
                             const Noise& noise) {
    const int edge_count = static_cast<int>(graph(scenario).size());
    Eigen::VectorXd z(step.rows);
    int row = 0;
    for (int j = 0; j < number_of_features(scenario); ++j) {
        if (!step.seen[static_cast<std::size_t>(j)]) continue;
        z.segment<2>(row) = measured_feature(scenario, world, k, j, noise);
        row += 2;
    }
    for (int e = 0; e < edge_count; ++e) {
        z.segment<2>(row) = measured_edge(scenario, world, k, e, noise);
        row += 2;
    }
    return z;
}

/// Whether a measurement of feature j, with the sigma that the filter believes, lies within the filter's gate: nu' S^-1
/// nu
/// <= -2 log(1 - gate), the quantile of chi-square with two degrees of freedom [docs/model.md, Filter, See].
bool inside_gate(const DeformableSettings& scenario, const Belief& prior, const Eigen::Vector2d& z, double sigma,
                 int j) {
    const Eigen::MatrixXd H = measurement_rows(scenario, prior.x, j);
    const Eigen::Matrix2d S = H * prior.P * H.transpose() + sigma * sigma * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d nu = z - predicted_measurement(scenario, prior.x, j);
    return scenario.filter.gate == 1 || nu.dot(S.inverse() * nu) <= -2 * std::log(1 - scenario.filter.gate);
}

/// Sees at pose k and updates the prior, gating and taking sigma at the true range; without a row the prior stays
/// [docs/model.md, Filter, See to Update].
Belief see_and_update(const DeformableSettings& scenario, const World& world, const Belief& prior, int k,
                      const Noise& noise, Step& step) {
    Eigen::VectorXd sigma(number_of_features(scenario));
    for (int j = 0; j < number_of_features(scenario); ++j) {
        const double q = (world.p.col(j) - world.r).norm();
        sigma[j] = scenario.filter.measurement * measurement_sigma(scenario, q);
        step.seen.push_back(k % scenario.sensor.every == 0 && in_range(scenario, q) &&
                            noise.uniform(Source::detection, k, j) < scenario.sensor.detection &&
                            inside_gate(scenario, prior, measured_feature(scenario, world, k, j, noise), sigma[j], j));
    }
    const Prediction prediction = predicted_measurements(scenario, prior.x, step.seen, sigma);
    step.rows = static_cast<int>(prediction.N.size());
    if (step.rows == 0) return prior;
    const Correction correction = correct(prior.P, prediction);
    step.innovation = measurements(scenario, world, k, step, noise) - prediction.z_hat;
    step.innovation_covariance = correction.S;
    step.condition_of_S = condition(correction.S);
    step.nis = step.innovation.dot(correction.S.ldlt().solve(step.innovation));
    return {prior.x + correction.K * step.innovation, correction.P};
}

/// Notes truth and belief after the update, and the reported trace.
void note(const DeformableSettings& scenario, const World& world, const Belief& belief, Step& step) {
    step.truth = true_state(scenario, world);
    step.mean = belief.x;
    step.covariance = belief.P;
    step.trace_P = scenario.filter.covariance * belief.P.trace();
}

/// Figures of the whole trial from its steps [docs/model.md, Reported per trial].
void sum_up(const DeformableSettings& scenario, Trial& trial) {
    double nees = 0, nis = 0, rows = 0, log_determinants = 0;
    for (std::size_t k = 0; k < trial.steps.size(); ++k) {
        const Step& step = trial.steps[k];
        trial.pose_error += (step.mean - step.truth).head(pose_dimension(scenario)).squaredNorm();
        if (k == 0) continue;
        for (const bool feature_seen : step.seen) trial.unseen += feature_seen ? 0 : 1;
        trial.path_length +=
            (step.truth - trial.steps[k - 1].truth).segment(row_of_position(scenario), 2).norm();
        nees += step.nees;
        const Eigen::MatrixXd L = (scenario.filter.covariance * step.covariance).llt().matrixL();
        log_determinants += 2 * L.diagonal().array().log().sum();
        nis += step.nis;
        rows += step.rows;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double moves = static_cast<double>(trial.steps.size()) - 1;
    trial.trace_P = trial.steps.back().trace_P;
    trial.nees_ratio = moves > 0 ? nees / moves / state_dimension(scenario) : none;
    trial.nis_ratio = rows > 0 ? nis / rows : none;
    const double constant = state_dimension(scenario) * std::log(2 * std::acos(-1));
    trial.log_score = moves > 0 ? (constant + (log_determinants + nees) / moves) / 2 : none;
}

}  // namespace

Trial run(const DeformableSettings& scenario, Controller controller, const Noise& noise) {
    Trial trial;
    World world = first_world(scenario, noise);
    Belief belief = first_belief(scenario, world, noise);
    trial.steps.emplace_back();
    note(scenario, world, belief, trial.steps.back());
    for (int k = 1; k < scenario.poses; ++k) {
        Step step;
        choose_control(scenario, controller, belief, k, noise, step);
        world = next_world(scenario, world, step.control, k, noise);
        const Belief prior = predict(scenario, belief, step.control, k);
        step.prior_mean = prior.x;
        step.prior_covariance = prior.P;
        belief = see_and_update(scenario, world, prior, k, noise, step);
        note(scenario, world, belief, step);
        step.nees = normalized_error(scenario, step);
        trial.steps.push_back(step);
    }
    sum_up(scenario, trial);
    return trial;
}

}  // namespace credence::oracle
