#pragma once
// The trial that both baselines run; they differ in their `Style`: the types, the prediction of P, and the solution for
// S.
//
//   x  mean [n], P  covariance [n, n], Q  diagonal of the process noise [n], R(theta) = [cos, -sin; sin, cos]
//   H  stacked rows of the seen features (body frame) and of all edges [m, n], N  their noise variances [m]
//   nu  innovation [m], S = H P H' + N [m, m], K = P H' S^-1 [n, m]

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "baseline.hpp"
#include "baseline_noise.hpp"

namespace credence::bench {

/// A seen feature: measured relative position (body frame) and noise variance of each axis.
struct Seen {
    int feature = 0;
    Eigen::Vector2d z;
    double variance = 0;
};

/// Filter and planner of docs/model.md.
template <class Style, Process process>
class Filter {
public:
    using State = typename Style::State;
    using Covariance = typename Style::Covariance;
    using Rows = typename Style::Rows;
    using Measurement = typename Style::Measurement;
    static constexpr bool has_heading = process == Process::heading;
    static constexpr int position = has_heading ? 1 : 0;

    explicit Filter(const ProblemView& problem) : problem_(problem), n_(problem.state_size), Q_(n_) {
        const FilterParameters& filter = problem.filter;
        Q_.setConstant(filter.variance_feature);
        if constexpr (has_heading) Q_[0] = filter.variance_heading;
        Q_.template segment<2>(position).setConstant(filter.variance_odometry);
        seen_.reserve(static_cast<std::size_t>(problem.features));
    }

    static int feature(int j) { return position + 2 + 2 * j; }

    static Eigen::Matrix2d rotation(const State& x) {
        if constexpr (has_heading) return Eigen::Rotation2Dd(x[0]).toRotationMatrix();
        return Eigen::Matrix2d::Identity();
    }

    bool in_range(double q) const { return q >= problem_.sensor.range_min && q <= problem_.sensor.range_max; }

    double sigma_at(double q) const {
        const SensorParameters& sensor = problem_.sensor;
        if (sensor.noise == RangeNoise::constant) return sensor.sigma;
        return sensor.sigma_near + sensor.sigma_slope * std::max(0.0, q - sensor.range_min);
    }

    /// The filter's assumed variance of a measurement whose standard deviation is sigma.
    double believed_variance(double sigma) const {
        const double believed = problem_.filter.measurement_factor * sigma;
        return believed * believed;
    }

    /// [docs/model.md, Predict] F = I, but F[r, theta] = R J v.
    void predict(State& x, Covariance& P, const Control& control, int k) const {
        Eigen::Vector2d move(control.move.x, control.move.y);
        if constexpr (has_heading) {
            move = rotation(x) * move;
            x[0] += control.turn;
            Style::transition(P, Eigen::Vector2d(-move.y(), move.x()));
        }
        x.template segment<2>(position) += move;
        for (int j = 0; j < problem_.features; ++j) {
            const Point &t = problem_.filter.translation[k - 1], &d = problem_.filter.sway_increment_at(k, j);
            x[feature(j)] += t.x + d.x;
            x[feature(j) + 1] += t.y + d.y;
        }
        P.diagonal() += Q_;
    }

    int rows(const std::vector<Seen>& seen) const {
        return 2 * (static_cast<int>(seen.size()) + problem_.filter.edge_count);
    }

    /// H and N at the predicted mean.
    void stack(const State& x, const std::vector<Seen>& seen, Rows& H, Measurement& N) const {
        const Eigen::Matrix2d Rt = rotation(x).transpose();
        H.setZero(rows(seen), n_);
        N.resize(rows(seen));
        int row = 0;
        for (const Seen& one : seen) {
            if constexpr (has_heading) {
                const Eigen::Vector2d z = Rt * difference(x, feature(one.feature), position);
                H(row, 0) = z.y();
                H(row + 1, 0) = -z.x();
            }
            H.template block<2, 2>(row, position) = -Rt;
            H.template block<2, 2>(row, feature(one.feature)) = Rt;
            N.template segment<2>(row).setConstant(one.variance);
            row += 2;
        }
        for (int e = 0; e < problem_.filter.edge_count; ++e, row += 2) {
            const Edge& edge = problem_.filter.edges[e];
            H.template block<2, 2>(row, feature(edge.from)) = -Eigen::Matrix2d::Identity();
            H.template block<2, 2>(row, feature(edge.to)).setIdentity();
            N.template segment<2>(row).setConstant(problem_.filter.variance_edge);
        }
    }

    /// nu = z - z^, of the seen features and of the edges, whose true differences edge_measurement(edge) gives.
    template <class EdgeMeasurement>
    Measurement innovation(const State& x, const std::vector<Seen>& seen, const EdgeMeasurement& z_edge) const {
        const Eigen::Matrix2d Rt = rotation(x).transpose();
        Measurement nu(rows(seen));
        int row = 0;
        for (const Seen& one : seen) {
            nu.template segment<2>(row) = one.z - Rt * difference(x, feature(one.feature), position);
            row += 2;
        }
        for (int e = 0; e < problem_.filter.edge_count; ++e, row += 2) {
            const Edge& edge = problem_.filter.edges[e];
            nu.template segment<2>(row) = z_edge(edge) - difference(x, feature(edge.to), feature(edge.from));
        }
        return nu;
    }

    /// [docs/model.md, Update]; returns nu' S^-1 nu.
    template <class EdgeMeasurement>
    double update(State& x, Covariance& P, const std::vector<Seen>& seen, const EdgeMeasurement& z_edge) const {
        Rows H;
        Measurement N;
        stack(x, seen, H, N);
        const Measurement nu = innovation(x, seen, z_edge);
        const typename Style::Gain gain(P, H, N);
        gain.correct(x, nu);
        gain.apply(P);
        Style::settle(P);
        return gain.squared(nu);
    }

    /// trace(P) after one step under a candidate, all of it by the filter's own equations.
    double candidate_cost(const State& x, const Covariance& P, const Control& candidate, int k) {
        State next = x;
        Covariance next_P = P;
        predict(next, next_P, candidate, k);
        seen_.clear();
        for (int j = 0; j < problem_.features; ++j) {
            const double q = difference(next, feature(j), position).norm();
            if (in_range(q)) seen_.push_back({j, {}, believed_variance(sigma_at(q))});
        }
        Rows H;
        Measurement N;
        stack(next, seen_, H, N);
        typename Style::Gain(next_P, H, N).apply(next_P);
        return next_P.trace();
    }

    /// The least cost wins, later wins ties [docs/model.md, Controllers].
    Control plan(const State& x, const Covariance& P, int k) {
        const ControlParameters& control = problem_.control;
        int chosen = 0;
        double best = std::numeric_limits<double>::infinity();
        for (int i = 0; i < control.candidate_count; ++i) {
            const double cost = candidate_cost(x, P, control.candidates[i], k);
            if (cost <= best * (1 + 1e-12)) chosen = i;
            best = std::min(best, cost);
        }
        return control.candidates[chosen];
    }

private:
    static Eigen::Vector2d difference(const State& x, int to, int from) {
        return x.template segment<2>(to) - x.template segment<2>(from);
    }

    const ProblemView& problem_;
    int n_;
    State Q_;
    std::vector<Seen> seen_;
};

}  // namespace credence::bench
