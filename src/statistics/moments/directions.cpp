#include "statistics/moments/directions.hpp"

#include <array>
#include <cmath>

#include "numeric/decompositions.hpp"

namespace credence {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Generalised eigenvalues, ascending, and eigenvectors v with v'Cv = 1 as columns; none where C is singular.
struct Extremes {
    VectorXd values;
    MatrixXd vectors;

    bool known() const { return values.size() > 0; }
    VectorXd of(bool largest) const { return vectors.col(largest ? vectors.cols() - 1 : 0); }
};

/// Of S v = lambda C v in the span of `basis`.
Extremes extremes_of(const MatrixXd& S, const MatrixXd& C, const MatrixXd& basis) {
    const CholeskyFactor factor(basis.transpose() * C * basis);
    if (basis.cols() == 0 || !factor.succeeded()) return {};
    const MatrixXd half = factor.solve_lower(basis.transpose() * S * basis);
    const MatrixXd whole = factor.solve_lower(half.transpose());
    const Eigenpairs pairs = eigenpairs((whole + whole.transpose()) / 2);
    if (!pairs.found) return {};
    return {pairs.values, basis * factor.solve_upper(pairs.vectors)};
}

double form(const VectorXd& v, const MatrixXd& matrix) { return v.dot(matrix * v); }

/// Moments of y_i = R + (a_i - R b_i) / mean b: one number per trial whose mean is R = sum a / sum b,
/// to first order. R is given, over all trials of the study.
PositiveSample linearised_ratio(const VectorXd& a, const VectorXd& b, double ratio, double trials) {
    const VectorXd y = (ratio + (a - ratio * b).array() / b.mean()).matrix();
    const double squares = (y.array() - y.mean()).square().sum();
    return {trials, ratio, std::sqrt(squares / static_cast<double>(y.size() - 1)), y.maxCoeff()};
}

/// The same direction v for every trial.
PositiveSample ratio_in(const VectorXd& v, const GroupMoments& group, const FoldSums& sums) {
    const VectorXd coefficients = form_coefficients(v);
    return linearised_ratio(group.S * coefficients, group.C * coefficients,
                            form(v, sums.all_S()) / form(v, sums.all_C()), sums.trials());
}

/// For every part the direction that the other parts give.
using FoldDirections = std::array<VectorXd, fold_count>;

PositiveSample crossed_ratio(const FoldDirections& v, const GroupMoments& group, const FoldSums& sums) {
    double sum_a = 0, sum_b = 0;
    MatrixXd coefficients(group.S.cols(), fold_count);
    for (int fold = 0; fold < fold_count; ++fold) {
        const auto h = static_cast<std::size_t>(fold);
        sum_a += form(v[h], sums.S[fold]);
        sum_b += form(v[h], sums.C[fold]);
        coefficients.col(fold) = form_coefficients(v[h]);
    }
    const MatrixXd a = group.S * coefficients, b = group.C * coefficients;
    VectorXd own_a(a.rows()), own_b(b.rows());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        own_a[i] = a(i, group.fold[static_cast<std::size_t>(i)]);
        own_b[i] = b(i, group.fold[static_cast<std::size_t>(i)]);
    }
    return linearised_ratio(own_a, own_b, sum_a / sum_b, sums.trials());
}

/// Whether the direction of some part has a cosine below 0.7 to v in the metric of C, v'Cv = 1.
bool is_approximate(const FoldDirections& folds, const VectorXd& v, const MatrixXd& C) {
    constexpr double close = 0.7;
    for (const VectorXd& other : folds)
        if (!(std::abs(other.dot(C * v)) >= close * std::sqrt(form(other, C) * form(v, C)))) return true;
    return false;
}

/// Entries below a tenth of the largest are left out.
std::vector<DirectionEntry> entries_of(const VectorXd& v, const std::vector<int>& components) {
    constexpr double smallest_share = 0.1;
    double most = 0;
    for (Eigen::Index j = 0; j < v.size(); ++j)
        if (std::abs(v[j]) > std::abs(most)) most = v[j];
    const double scale = (most < 0 ? -1 : 1) / v.norm();
    std::vector<DirectionEntry> entries;
    for (Eigen::Index j = 0; j < v.size(); ++j)
        if (std::abs(v[j]) >= smallest_share * std::abs(most))
            entries.push_back({components[static_cast<std::size_t>(j)], scale * v[j]});
    return entries;
}

bool enough_trials(const GroupMoments& group, const FoldSums& sums) {
    return sums.trials() >= direction_trials && group.trials() >= direction_trials;
}

}  // namespace

MatrixXd resolved_basis(const MatrixXd& sum_of_C, const DirectionLimits& limits) {
    const auto d = static_cast<double>(sum_of_C.rows());
    const MatrixXd mean = sum_of_C * (d / sum_of_C.trace());  // its diagonal is 1
    const Eigenpairs pairs = eigenpairs(mean);
    const double least = d * limits.epsilon / (rounding_share * limits.margin);
    const Eigen::Index left_out = (pairs.values.array() < least).count();
    if (left_out == 0) return MatrixXd::Identity(mean.rows(), mean.cols());
    return pairs.vectors.rightCols(mean.cols() - left_out);
}

GroupDirections find_directions(const GroupMoments& group, const FoldSums& sums, double level,
                                const DirectionLimits& limits) {
    GroupDirections found;
    found.trials = sums.trials();
    if (!enough_trials(group, sums)) return found;
    const MatrixXd basis = resolved_basis(sums.all_C(), limits), mean_C = sums.all_C() / sums.trials();
    found.left_out = group.dimension() - static_cast<int>(basis.cols());
    found.state = GroupDirections::State::singular;
    const Extremes all = extremes_of(sums.all_S(), sums.all_C(), basis);
    if (!all.known()) return found;
    std::array<Extremes, fold_count> others;
    for (int fold = 0; fold < fold_count; ++fold) {
        Extremes& other = others[static_cast<std::size_t>(fold)];
        other = extremes_of(sums.mean_S_without(fold), sums.mean_C_without(fold), basis);
        if (!other.known()) return found;
    }
    found.state = GroupDirections::State::known;
    for (const bool largest : {true, false}) {
        const FoldDirections folds{others[0].of(largest), others[1].of(largest), others[2].of(largest)};
        PositiveSample sample = crossed_ratio(folds, group, sums);
        sample.of_few_numbers = limits.steps * group.dimension() < many_numbers;
        if (!limits.of_segments && !sample.of_few_numbers) sample.largest = 0;
        // Of many trials Student's interval needs no help.
        const MeanClaim claim = sample.trials < 200 ? claim_on_nees(sample, degrees_over_steps(sample, 1, limits.steps),
                                                                    level, limits.margin)
                                                    : claim_on_mean(sample, level, limits.margin);
        const VectorXd v = all.of(largest);
        Direction& direction = largest ? found.largest : found.smallest;
        direction.entries = entries_of(v, group.components);
        direction.approximate = is_approximate(folds, v, mean_C);
        direction.ratio = sample;
        direction.bounds = claim.bounds;
        direction.finding = largest ? claim.above : claim.below;
    }
    return found;
}

DirectionsAccepted accept_directions(const GroupMoments& state, const FoldSums& sums, const DirectionLimits& limits) {
    DirectionsAccepted accepted;
    if (!enough_trials(state, sums)) return accepted;
    const MatrixXd basis = resolved_basis(sums.all_C(), limits);
    accepted.left_out = state.dimension() - static_cast<int>(basis.cols());
    const Extremes all = extremes_of(sums.all_S(), sums.all_C(), basis);
    accepted.state = all.known() ? GroupDirections::State::known : GroupDirections::State::singular;
    if (!all.known()) return accepted;
    const PositiveSample smallest = ratio_in(all.of(false), state, sums), largest = ratio_in(all.of(true), state, sums);
    accepted.spectrum = {all.values.begin(), all.values.end()};
    accepted.bounds = acceptance_interval(smallest, largest);
    accepted.shown = margin_shown(accepted.bounds);
    return accepted;
}

}  // namespace credence
