#include "filters.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <memory>

namespace credence::rates {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The whole state, and from four components up its halves.
std::vector<ComponentGroup> halves(int n) {
    std::vector<ComponentGroup> groups{{"all", 0, n}};
    if (n >= 4) {
        groups.push_back({"first", 0, n / 2});
        groups.push_back({"second", n / 2, n - n / 2});
    }
    return groups;
}

/// Normal numbers of variance 1 along a path, correlated from step to step.
MatrixXd normal_path(const Draws& draws, Purpose purpose, int n, int steps, double correlation) {
    MatrixXd path(n, steps);
    const double fresh = std::sqrt(1 - correlation * correlation);
    for (int k = 0; k < steps; ++k)
        for (int j = 0; j < n; ++j) {
            const double draw = draws.normal(purpose, k, j);
            path(j, k) = k == 0 ? draw : correlation * path(j, k - 1) + fresh * draw;
        }
    return path;
}

/// The factor that makes a normal number one of Student's t with five degrees of freedom and variance 1.
double t5_scale(const Draws& draws, int step, int index) {
    double chi_square = 0;
    for (int i = 0; i < 5; ++i) chi_square += std::pow(draws.normal(Purpose::scale, step, 5 * index + i), 2);
    return std::sqrt(3 / chi_square);
}

/// The factor that makes a normal number one of Laplace's distribution with variance 1.
double laplace_scale(const Draws& draws, int step, int index) {
    return std::sqrt(-std::log1p(-draws.uniform(step, index)));
}

/// So many sigma in a share of the draws, and a variance of 1 over all.
double contaminated_scale(const Draws& draws, int step, double share, double sigmas) {
    return (draws.uniform(step, 0) < share ? sigmas : 1) / std::sqrt(1 + share * (sigmas * sigmas - 1));
}

/// The scale of one component at one step.
double scale_of(Tails tails, const Draws& draws, int step, int component) {
    switch (tails) {
        case Tails::normal: break;
        case Tails::t5_trial: return t5_scale(draws, 0, 0);
        case Tails::t5_step: return t5_scale(draws, step, 0);
        case Tails::t5_component: return t5_scale(draws, step, component);
        case Tails::t5_component_trial: return t5_scale(draws, 0, component);
        case Tails::laplace: return laplace_scale(draws, step, component);
        case Tails::contaminated_steps: return contaminated_scale(draws, step, 0.05, 3);
        case Tails::contaminated_trials: return contaminated_scale(draws, 0, 0.05, 3);
        case Tails::outlying_steps: return contaminated_scale(draws, step, 0.01, 5);
        case Tails::rarely_diverged: return draws.uniform(0, 0) < 0.003 ? 8 : 1;
        case Tails::diverged: return draws.uniform(0, 0) < 0.01 ? 10 : 1;
    }
    return 1;
}

MatrixXd errors(const Draws& draws, const Path& path) {
    MatrixXd error = normal_path(draws, Purpose::error, path.n, path.steps, path.correlation);
    if (path.tails == Tails::normal) return error;
    for (int k = 0; k < path.steps; ++k)
        for (int j = 0; j < path.n; ++j) error(j, k) *= scale_of(path.tails, draws, k, j);
    return error;
}

/// A filter that says 1 while its errors are those of the path times `shape`.
Filter shaped(const Path& path, const MatrixXd& shape) {
    Filter filter = right(path);
    filter.trial = [path, shape](const Draws& draws) { return Trial{shape * errors(draws, path), {}}; };
    return filter;
}

constexpr int tracker_steps = 10;

/// The covariance and the gain of the tracker at every step.
struct Gains {
    MatrixXd F = MatrixXd::Identity(4, 4), G = MatrixXd::Zero(4, 2), H = MatrixXd::Identity(2, 4);
    MatrixXd first = VectorXd{{1, 1, 0.25, 0.25}}.asDiagonal();
    std::vector<MatrixXd> covariance, gain;

    Gains() {
        constexpr double acceleration = 0.1;
        F(0, 2) = F(1, 3) = 1;
        G(0, 0) = G(1, 1) = acceleration / 2;
        G(2, 0) = G(3, 1) = acceleration;
        MatrixXd P = first;
        for (int k = 0; k < tracker_steps; ++k) {
            P = F * P * F.transpose() + G * G.transpose();
            const MatrixXd S = H * P * H.transpose() + MatrixXd::Identity(2, 2);
            gain.push_back(P * H.transpose() * S.inverse());
            P -= gain.back() * S * gain.back().transpose();
            P = (P + P.transpose().eval()) / 2;
            covariance.push_back(P);
        }
    }

    /// The errors of one run of the filter, whose model is right.
    MatrixXd errors(const Draws& draws) const {
        MatrixXd error(4, tracker_steps);
        VectorXd e(4), process(2), measurement(2);
        for (int j = 0; j < 4; ++j) e(j) = std::sqrt(first(j, j)) * draws.normal(Purpose::error, 0, j);
        for (int k = 0; k < tracker_steps; ++k) {
            for (int j = 0; j < 2; ++j) {
                process(j) = draws.normal(Purpose::process, k, j);
                measurement(j) = draws.normal(Purpose::measurement, k, j);
            }
            e = F * e - G * process;
            e += gain[static_cast<std::size_t>(k)] * (measurement - H * e);
            error.col(k) = e;
        }
        return error;
    }
};

}  // namespace

Draws::Draws(std::uint64_t seed, std::int64_t trial)
    : keyed_(seed, static_cast<std::uint64_t>(trial), std::numeric_limits<double>::infinity()) {}

double Draws::normal(Purpose purpose, int step, int index) const {
    return keyed_.normal(static_cast<Source>(purpose), step, index).x;
}

double Draws::uniform(int step, int index) const {
    return keyed_.uniform(static_cast<Source>(Purpose::scale), step, index);
}

Filter right(const Path& path) {
    const MatrixXd one = MatrixXd::Identity(path.n, path.n);
    return {halves(path.n), std::vector<MatrixXd>(static_cast<std::size_t>(path.steps), one), 0,
            [path](const Draws& draws) { return Trial{errors(draws, path), {}}; }};
}

Filter scaled(const Path& path, double factor) {
    Filter filter = right(path);
    for (MatrixXd& P : filter.covariance) P *= factor;
    return filter;
}

Filter dropped(const Path& path, double correlation) {
    MatrixXd shape = MatrixXd::Identity(path.n, path.n);
    shape(path.n - 1, 0) = correlation;
    shape(path.n - 1, path.n - 1) = std::sqrt(1 - correlation * correlation);
    return shaped(path, shape);
}

Filter wrong_group(const Path& path, double factor) {
    Filter filter = right(path);
    const ComponentGroup& group = filter.groups.back();
    for (MatrixXd& P : filter.covariance) P.block(group.first, group.first, group.count, group.count) *= factor;
    return filter;
}

Filter wrong_direction(const Path& path, double variance) {
    const VectorXd direction = VectorXd::Constant(path.n, 1 / std::sqrt(path.n));
    return shaped(path, MatrixXd::Identity(path.n, path.n) +
                            (std::sqrt(variance) - 1) * direction * direction.transpose());
}

Filter biased(const Path& path, double sigmas) {
    Filter filter = right(path);
    filter.trial = [path, sigmas](const Draws& draws) {
        Trial trial{errors(draws, path), {}};
        trial.error.row(0).array() += sigmas;
        return trial;
    };
    return filter;
}

Filter with_innovations(const Path& path, double correlation) {
    Filter filter = right(path);
    filter.rows = 2;
    filter.trial = [path, correlation](const Draws& draws) {
        return Trial{errors(draws, path), normal_path(draws, Purpose::innovation, 2, path.steps, correlation)};
    };
    return filter;
}

Filter tracker(const Tracker& settings) {
    const auto gains = std::make_shared<const Gains>();
    Filter filter{{{"all", 0, 4}, {"position", 0, 2}, {"velocity", 2, 2}}, gains->covariance, 0, {}};
    const double position = std::sqrt(settings.position);
    const VectorXd said = VectorXd{{position, position, 1, 1}} * std::sqrt(settings.covariance);
    VectorXd offset(tracker_steps);
    for (int k = 0; k < tracker_steps; ++k) {
        MatrixXd& P = filter.covariance[static_cast<std::size_t>(k)];
        offset(k) = settings.bias * std::sqrt(P(0, 0));
        P = (said.asDiagonal() * P * said.asDiagonal()).eval();
    }
    filter.trial = [gains, offset](const Draws& draws) {
        Trial trial{gains->errors(draws), {}};
        trial.error.row(0) += offset.transpose();
        return trial;
    };
    return filter;
}

}  // namespace credence::rates
