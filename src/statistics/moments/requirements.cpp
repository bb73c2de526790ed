#include "statistics/moments/requirements.hpp"

#include <credence/detail/draws.hpp>
#include <limits>

#include "numeric/decompositions.hpp"

namespace credence {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double deviation(const VectorXd& values) {
    return std::sqrt((values.array() - values.mean()).square().sum() / static_cast<double>(values.size() - 1));
}

/// One number per trial.
template <class Value>
VectorXd by_trial(const TrialMoments& trials, const Value& value) {
    VectorXd result(static_cast<Eigen::Index>(trials.trials()));
    for (std::size_t i = 0; i < trials.trials(); ++i) result[static_cast<Eigen::Index>(i)] = value(i);
    return result;
}

/// [trials, draws]: standard normal multipliers over sqrt(T), which sum to 0 in every draw. Their key is not that of
/// any trial's noise.
MatrixXd multipliers(const TrialMoments& trials, std::uint64_t root_seed) {
    constexpr std::uint64_t purpose = 0x616476696365;  // "advice"
    const auto count = static_cast<Eigen::Index>(trials.trials());
    MatrixXd drawn(count, advice_draws);
    for (Eigen::Index i = 0; i < count; ++i) {
        const KeyedDraws<double> keyed(root_seed ^ purpose,
                                       static_cast<std::uint64_t>(trials.trial[static_cast<std::size_t>(i)]),
                                       std::numeric_limits<double>::infinity());
        for (int b = 0; b < advice_draws; b += 2) {
            const Vector2<double> pair = keyed.normal(Source{}, b / 2, 0);
            drawn(i, b) = pair.x;
            drawn(i, b + 1) = pair.y;
        }
    }
    for (int b = 0; b < advice_draws; ++b) drawn.col(b).array() -= drawn.col(b).mean();
    return drawn / std::sqrt(static_cast<double>(count));
}

void require_run(const VectorXd& X, const MatrixXd& drawn, double margin, std::vector<Requirement>& all) {
    const VectorXd values = X / X.mean(), deviates = drawn.transpose() * values;
    const double half = normal_quantile(2 * levels::acceptance) * deviation(values);
    const VectorXd above = deviates.array() + half * (1 + margin), below = half - deviates.array();
    all.push_back({margin, values, above});
    all.push_back({margin, values, below});
}

void require_bias(const VectorXd& z, const MatrixXd& drawn, double margin, std::vector<Requirement>& all) {
    const double half = normal_quantile(2 * levels::acceptance) * deviation(z);
    const VectorXd scaled = (drawn.transpose() * z).array().abs() + half;
    all.push_back({margin, z, scaled});
}

/// The triangles of R_i = A S_i A' - D C_i D', A and D the inverse Cholesky factors of mean S and mean C: residuals of
/// an exactly consistent filter, in coordinates where mean P is I. Empty where one of them is singular.
MatrixXd residuals(const GroupMoments& group) {
    const int d = group.dimension();
    const CholeskyFactor S(symmetric(group.S.colwise().mean(), d)), C(symmetric(group.C.colwise().mean(), d));
    if (!S.succeeded() || !C.succeeded()) return {};
    if (!(S.rcond() > least_rcond && C.rcond() > least_rcond)) return {};
    const MatrixXd I = MatrixXd::Identity(d, d), A = S.solve_lower(I), D = C.solve_lower(I);
    MatrixXd triangles(group.S.rows(), group.S.cols());
    for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
        const MatrixXd R =
            A * symmetric(group.S.row(i), d) * A.transpose() - D * symmetric(group.C.row(i), d) * D.transpose();
        for (int a = 0; a < d; ++a)
            for (int b = 0; b <= a; ++b) triangles(i, triangle_place(a, b)) = R(a, b);
    }
    return triangles;
}

/// R [trials, d(d+1)/2].
void require_directions(const MatrixXd& R, int dimension, const MatrixXd& drawn, double margin,
                        std::vector<Requirement>& all) {
    const double z = normal_quantile(2 * levels::acceptance);
    VectorXd above(advice_draws), below(advice_draws), up, down;
    for (int b = advice_draws - 1; b >= 0; --b) {  // the values of the first draw stay
        const VectorXd triangle = R.transpose() * drawn.col(b);
        const Eigenpairs pairs = eigenpairs(symmetric(triangle, dimension));
        up = R * form_coefficients(pairs.vectors.col(dimension - 1));
        down = R * form_coefficients(pairs.vectors.col(0));
        above[b] = pairs.values[dimension - 1] + z * deviation(up) * (1 + margin);
        below[b] = z * deviation(down) - pairs.values[0];
    }
    all.push_back({margin, up, above});
    all.push_back({margin, down, below});
}

}  // namespace

std::optional<std::vector<Requirement>> requirements_of(const TrialMoments& trials, const std::vector<int>& state,
                                                        std::uint64_t root_seed, const AdviceLimits& limits) {
    std::vector<Requirement> all;
    const MatrixXd drawn = multipliers(trials, root_seed);
    for (int g = 0; g < trials.groups; ++g) {
        const VectorXd X = by_trial(trials, [&](std::size_t i) { return trials.X(i, g); });
        require_run(X, drawn, limits.margin, all);
    }
    for (const int j : state) {
        const VectorXd z = by_trial(trials, [&](std::size_t i) { return trials.z(i, j); });
        require_bias(z, drawn, limits.bias, all);
    }
    if (state.size() < 2) return all;
    const MatrixXd R = residuals(group_moments(trials, state));
    if (R.size() == 0) return std::nullopt;
    require_directions(R, static_cast<int>(state.size()), drawn, limits.direction, all);
    return all;
}

double quantile_of(const VectorXd& values, double p) {
    std::vector<double> copy(values.data(), values.data() + values.size());
    return quantile(copy, p);
}

}  // namespace credence
