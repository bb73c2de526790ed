#include "estimators.hpp"

#include <cmath>

namespace credence::oracle {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using test::RunStep;

constexpr int theta = 0, r = 1;

Vector2d point(const VectorXd& x, int index) { return x.segment<2>(index); }

/// The measurements of one pose, stacked: seen features in the body frame, then edges.
struct Measurements {
    std::vector<int> seen;
    std::vector<Edge> edges;
    VectorXd z, variance;

    Measurements(const DeformableSettings& scenario, const RunStep& step) : edges(graph(scenario)) {
        for (std::size_t j = 0; j < step.seen.size(); ++j)
            if (step.seen[j]) seen.push_back(static_cast<int>(j));
        const auto count = static_cast<Eigen::Index>(seen.size() + edges.size());
        z.resize(2 * count);
        variance.resize(2 * count);
        Eigen::Index row = 0;
        for (const int j : seen) {
            z.segment<2>(row) = step.sighting.row(j).transpose();
            variance.segment<2>(row).setConstant(std::pow(scenario.filter.measurement * step.sigma[j], 2));
            row += 2;
        }
        for (std::size_t e = 0; e < edges.size(); ++e) {
            z.segment<2>(row) = step.edge.row(static_cast<Eigen::Index>(e)).transpose();
            variance.segment<2>(row).setConstant(std::pow(scenario.filter.edges * scenario.noise.deformation, 2));
            row += 2;
        }
    }

    int feature(int j) const { return r + 2 + 2 * j; }

    VectorXd expected(const VectorXd& x) const {
        VectorXd h(z.size());
        Eigen::Index row = 0;
        for (const int j : seen) {
            h.segment<2>(row) = rotation(x[theta]).transpose() * (point(x, feature(j)) - point(x, r));
            row += 2;
        }
        for (const Edge& edge : edges) {
            h.segment<2>(row) = point(x, feature(edge.to)) - point(x, feature(edge.from));
            row += 2;
        }
        return h;
    }

    MatrixXd jacobian(const VectorXd& x) const {
        MatrixXd H = MatrixXd::Zero(z.size(), x.size());
        Eigen::Index row = 0;
        for (const int j : seen) {
            const Matrix2d into_body = rotation(x[theta]).transpose();
            H.block<2, 1>(row, theta) = -quarter_turn() * into_body * (point(x, feature(j)) - point(x, r));
            H.block<2, 2>(row, r) = -into_body;
            H.block<2, 2>(row, feature(j)) = into_body;
            row += 2;
        }
        for (const Edge& edge : edges) {
            H.block<2, 2>(row, feature(edge.from)) = -Matrix2d::Identity();
            H.block<2, 2>(row, feature(edge.to)) = Matrix2d::Identity();
            row += 2;
        }
        return H;
    }

    MatrixXd gain(const MatrixXd& H, const MatrixXd& P) const {
        const MatrixXd S = H * P * H.transpose() + MatrixXd(variance.asDiagonal());
        return S.ldlt().solve(H * P).transpose();
    }
};

VectorXd predicted_mean(const VectorXd& x, const RunStep& step, const VectorXd& prior) {
    VectorXd next = prior;  // features: their known motion is the run's own, checked elsewhere
    next[theta] = x[theta] + step.control.turn;
    next.segment<2>(r) = point(x, r) + rotation(x[theta]) * Vector2d(step.control.move.x, step.control.move.y);
    return next;
}

MatrixXd process_noise_of(const DeformableSettings& scenario, Eigen::Index n) {
    const auto squared = [](double sigma) { return sigma * sigma; };
    VectorXd q = VectorXd::Constant(n, squared(scenario.noise.walk) + squared(scenario.noise.deformation));
    q[theta] = squared(scenario.noise.heading);
    q.segment<2>(r).setConstant(squared(scenario.noise.odometry));
    return q.asDiagonal();
}

/// The right-invariant filter in its own chart: eta = chi chi^^-1, P of its logarithm.
Estimate right_invariant_step(const DeformableSettings& scenario, const RunStep& step, const Estimate& before,
                              const VectorXd& feature_motion) {
    const Eigen::Index n = before.mean.size();
    const MatrixXd T_before = chart(before.mean);
    VectorXd x = predicted_mean(before.mean, step, before.mean + feature_motion);
    MatrixXd F = MatrixXd::Identity(n, n);
    for (Eigen::Index i = r + 2; i < n; i += 2)
        F.block<2, 1>(i, theta) = -quarter_turn() * feature_motion.segment<2>(i);
    const MatrixXd G = chart(x);
    const MatrixXd P = F * T_before * before.covariance * T_before.transpose() * F.transpose() +
                       G * process_noise_of(scenario, n) * G.transpose();
    const Measurements measured(scenario, step);
    MatrixXd H = measured.jacobian(x);
    for (Eigen::Index row = 0; row < H.rows(); ++row) H(row, theta) = 0;
    for (std::size_t e = 0; e < measured.edges.size(); ++e) {
        const Edge& edge = measured.edges[e];
        H.block<2, 1>(static_cast<Eigen::Index>(2 * (measured.seen.size() + e)), theta) =
            quarter_turn() * (point(x, measured.feature(edge.to)) - point(x, measured.feature(edge.from)));
    }
    const MatrixXd K = measured.gain(H, P);
    x = moved(x, K * (measured.z - measured.expected(x)));
    const MatrixXd back = chart(x).inverse();
    return {x, back * (P - K * H * P) * back.transpose()};
}

/// The state of the first-estimates filter beside the belief.
struct First {
    Vector2d position;
    VectorXd points;  ///< first estimates at their places in the state
};

Estimate euclidean_step(const DeformableSettings& scenario, Estimator estimator, const RunStep& previous,
                        const RunStep& step, const Estimate& before, const VectorXd& feature_motion, First& first) {
    const Eigen::Index n = before.mean.size();
    const VectorXd x = predicted_mean(before.mean, step, before.mean + feature_motion);
    Vector2d displacement = point(x, r) - point(before.mean, r);
    if (estimator == Estimator::ideal) displacement = point(step.truth, r) - point(previous.truth, r);
    if (estimator == Estimator::fej) displacement = point(x, r) - first.position;
    MatrixXd F = MatrixXd::Identity(n, n);
    F.block<2, 1>(r, theta) = quarter_turn() * displacement;
    const MatrixXd P = F * before.covariance * F.transpose() + process_noise_of(scenario, n);
    first.position = point(x, r);
    first.points = process_noise_of(scenario, n)(n - 1, n - 1) > 0 ? x : VectorXd(first.points + feature_motion);

    const Measurements measured(scenario, step);
    VectorXd at = estimator == Estimator::ideal ? step.truth : x;
    if (estimator == Estimator::fej) at.tail(n - r - 2) = first.points.tail(n - r - 2);
    MatrixXd H = measured.jacobian(at), K = measured.gain(H, P);
    VectorXd delta = K * (measured.z - measured.expected(x));
    for (int pass = 1; estimator == Estimator::iekf && pass < 8; ++pass) {
        H = measured.jacobian(x + delta);
        K = measured.gain(H, P);
        delta = K * (measured.z - measured.expected(x + delta) + H * delta);
    }
    return {x + delta, P - K * H * P};
}

}  // namespace

MatrixXd chart(const VectorXd& x) {
    MatrixXd T = MatrixXd::Identity(x.size(), x.size());
    for (Eigen::Index i = r; i < x.size(); i += 2) T.block<2, 1>(i, theta) = -quarter_turn() * x.segment<2>(i);
    return T;
}

VectorXd moved(const VectorXd& x, const VectorXd& xi) {
    const double a = xi[theta];
    Matrix2d V = Matrix2d::Identity();
    if (a != 0) V << std::sin(a) / a, -(1 - std::cos(a)) / a, (1 - std::cos(a)) / a, std::sin(a) / a;
    VectorXd result = x;
    result[theta] += a;
    for (Eigen::Index i = r; i < x.size(); i += 2)
        result.segment<2>(i) = rotation(a) * x.segment<2>(i) + V * xi.segment<2>(i);
    return result;
}

std::vector<Estimate> estimates(const DeformableSettings& scenario, Estimator estimator, const test::Run& run) {
    std::vector<Estimate> all{{run.steps.front().mean, run.steps.front().covariance}};
    First first{point(all.front().mean, r), all.front().mean};
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        const RunStep &before = run.steps[k - 1], &step = run.steps[k];
        VectorXd motion = step.prior_mean - before.mean;  // known to every filter: t + d
        motion.head<3>().setZero();
        all.push_back(estimator == Estimator::riekf
                          ? right_invariant_step(scenario, step, all.back(), motion)
                          : euclidean_step(scenario, estimator, before, step, all.back(), motion, first));
    }
    return all;
}

}  // namespace credence::oracle
