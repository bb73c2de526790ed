#include "statistics/moments/advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <credence/detail/draws.hpp>
#include "numeric/decompositions.hpp"
#include "statistics/moments/directions.hpp"

namespace credence {

namespace {

/// Number of studies that are drawn.
constexpr int advice_draws = 400;

/// One thing that must be shown: N trials are enough if scaled / sqrt(N) is at most the margin.
struct Requirement {
    double margin = 0;
    Eigen::VectorXd values;  ///< [trials] of this study
    Eigen::VectorXd scaled;  ///< by draw

    /// The least N of each draw.
    Eigen::VectorXd trials() const { return (scaled.cwiseMax(0) / margin).cwiseAbs2(); }

    /// The number's uncertainty as a factor, 90 %: sd^2 has the relative variance (kurtosis - 1)/T, the number is
    /// proportional to it, and 10 % are for what else is estimated.
    double uncertainty() const {
        const Eigen::ArrayXd squares = (values.array() - values.mean()).square();
        const double kurtosis = squares.square().mean() / (squares.mean() * squares.mean());
        return std::exp(1.645 * std::sqrt((kurtosis - 1) / static_cast<double>(values.size()) + 0.01));
    }
};

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

/// All requirements; every trial must have every component. Nothing where the mean of S or C is singular.
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

/// Quantile of type 7.
double quantile_of(const VectorXd& values, double p) {
    std::vector<double> copy(values.data(), values.data() + values.size());
    return quantile(copy, p);
}

/// More than the 80 % of studies that are promised, for the noise of the advice itself.
constexpr double advised_share = 0.85;

bool is_complete(const TrialMoments& trials, std::size_t i, const std::vector<int>& state) {
    const double* row = trials.row(i);
    bool complete = std::none_of(row, row + trials.groups, [](double value) { return std::isnan(value); });
    for (const int j : state) complete = complete && !std::isnan(trials.z(i, j));
    for (const int a : state)
        for (const int b : state) {
            const int place = triangle_place(std::max(a, b), std::min(a, b));
            complete = complete && !std::isnan(trials.S(i)[place] + trials.C(i)[place]);
        }
    return complete;
}

TrialMoments complete_trials(const TrialMoments& trials, const std::vector<int>& state) {
    TrialMoments complete{trials.components, trials.groups, {}, {}};
    for (std::size_t i = 0; i < trials.trials(); ++i)
        if (is_complete(trials, i, state))
            std::copy(trials.row(i), trials.row(i) + trials.size(), complete.append(trials.trial[i]));
    return complete;
}

/// The number at which all requirements hold in the share of draws.
double number_for_all(const std::vector<Requirement>& requirements) {
    Eigen::VectorXd most = Eigen::VectorXd::Zero(advice_draws);
    for (const Requirement& one : requirements) most = most.cwiseMax(one.trials());
    return quantile_of(most, advised_share);
}

/// What needs most trials.
const Requirement& binding_one(const std::vector<Requirement>& requirements) {
    return *std::ranges::max_element(
        requirements, {}, [](const Requirement& one) { return quantile_of(one.trials(), advised_share); });
}

}  // namespace

std::optional<Advice> trials_for_consistent(const TrialMoments& trials, const std::vector<int>& state,
                                            std::uint64_t root_seed, const AdviceLimits& limits) {
    const TrialMoments complete = complete_trials(trials, state);
    if (static_cast<double>(complete.trials()) < advice_trials) return std::nullopt;
    const auto requirements = requirements_of(complete, state, root_seed, limits);
    if (!requirements) return std::nullopt;
    const double least = state.size() >= 2 ? direction_trials : 2;
    const double number = std::max(least, number_for_all(*requirements));
    const double factor = binding_one(*requirements).uncertainty();
    return Advice{number, {number / factor, number * factor}};
}

double trials_to_show(const PositiveSample& sample, double level, double margin) {
    const double a = t_quantile(2 * level, sample.trials - 1) * sample.standard_deviation;
    const double room = std::abs(sample.mean - 1) - margin;
    if (!(room > 0)) return std::numeric_limits<double>::infinity();
    // To first order in 1/N, what is allowed for trials that were not seen; only where the mean is too small.
    const double c = sample.mean < 1 ? -std::log(levels::unseen) * (unseen_size - 1) * sample.mean : 0;
    return std::pow((a + std::sqrt(a * a + 4 * room * c)) / (2 * room), 2);
}

double trials_to_show_bias(const Moments& z, double level, double margin) {
    const double room = std::abs(z.mean) - margin;
    if (!(room > 0)) return std::numeric_limits<double>::infinity();
    return std::pow(t_quantile(2 * level, z.count - 1) * z.standard_deviation / room, 2);
}

}  // namespace credence
