#include "worlds/own/step.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

enum class Definiteness { positive, singular, indefinite };

/// The smallest eigenvalue of the correlation matrix tells, whatever the units: rounding alone, of values with the
/// relative spacing `epsilon`, makes up to 2 n epsilon of a 0.
Definiteness definiteness(const Eigen::MatrixXd& S, double epsilon) {
    const Eigen::VectorXd size = S.diagonal().cwiseAbs().cwiseSqrt();
    const Eigen::VectorXd scale = (size.array() > 0).select(size.cwiseInverse(), 1.0);
    const Eigen::MatrixXd correlation = scale.asDiagonal() * S * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
    const double smallest = solver.eigenvalues().minCoeff(), zero = 2 * static_cast<double>(S.rows()) * epsilon;
    if (smallest > zero) return Definiteness::positive;
    return smallest < -zero ? Definiteness::indefinite : Definiteness::singular;
}

/// Factors S; what is wrong with it, where it is not positive definite. Pivots that are not small need no eigenvalues.
std::string factor(const Eigen::Ref<const Eigen::MatrixXd>& S, double epsilon, Eigen::LLT<Eigen::MatrixXd>& factor) {
    factor.compute(S);
    const bool factored = factor.info() == Eigen::Success;
    if (factored) {
        const auto pivots = factor.matrixLLT().diagonal().array().square();
        if ((pivots > 10 * std::sqrt(epsilon) * S.diagonal().array()).all()) return {};
    }
    const Definiteness found = definiteness(S, epsilon);
    if (factored && found == Definiteness::positive) return {};
    return found == Definiteness::singular ? "is singular" : "is not positive definite";
}

}  // namespace

bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix, double epsilon) {
    Eigen::LLT<Eigen::MatrixXd> any;
    return factor(matrix, epsilon, any).empty();
}

StateSeries record_series(const RecordShape& shape) {
    std::vector<Component> components;
    for (int j = 0; j < shape.n; ++j) components.push_back({"x" + std::to_string(j), "1"});
    StateSeries all_series(components, shape.groups, shape.has_innovations() ? Innovations::given : Innovations::none);
    for (Series& series : all_series.list)
        if (series.role == SeriesRole::squared_error || series.role == SeriesRole::variance)
            series.unit = "unit of error squared";
    return all_series;
}

bool figures_add_up(const double* all_series, std::size_t count) {
    constexpr double largest = 1e140;
    return std::all_of(all_series, all_series + count, [](double value) { return std::abs(value) <= largest; });
}

StepEvaluator::StepEvaluator(const RecordShape& shape, const StateSeries& all_series)
    : shape_(shape), places_(all_series), factors_(shape.groups.size()), solved_(shape.groups.size()) {}

std::string StepEvaluator::judge(const CheckedStep& step, double* all_series, double* whitened) {
    for (std::size_t b = 0; b < shape_.groups.size(); ++b) {
        const ComponentGroup& block = shape_.groups[b];
        const auto P = step.P.block(block.first, block.first, block.count, block.count);
        const auto e = step.e.segment(block.first, block.count);
        const std::string wrong = factor(P, shape_.covariance_epsilon, factors_[b]);
        if (!wrong.empty()) return "covariance " + wrong;
        solved_[b] = e;
        factors_[b].matrixL().solveInPlace(solved_[b]);
        all_series[b] = solved_[b].squaredNorm();
        all_series[places_.squared_error + b] = e.squaredNorm();
        all_series[places_.variance + b] = P.trace();
    }
    for (int j = 0; j < shape_.n; ++j)
        all_series[places_.standardised_error + static_cast<std::size_t>(j)] = step.e(j) / std::sqrt(step.P(j, j));
    if (!shape_.has_innovations()) return {};

    std::fill(whitened, whitened + shape_.m, nan);
    all_series[places_.nis] = 0;
    all_series[places_.rows] = static_cast<double>(step.rows.size());
    if (step.rows.empty()) return {};
    const std::string wrong = factor(step.S, shape_.innovation_epsilon, innovation_factor_);
    if (!wrong.empty()) return "innovation covariance " + wrong;
    white_ = step.nu;
    innovation_factor_.matrixL().solveInPlace(white_);
    all_series[places_.nis] = white_.squaredNorm();
    for (std::size_t i = 0; i < step.rows.size(); ++i)
        whitened[step.rows[i]] = white_(static_cast<Eigen::Index>(i));
    return {};
}

}  // namespace credence
