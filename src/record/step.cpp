#include "record/step.hpp"

#include "base/formatted.hpp"

#include <credence/detail/elementary.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

bool CheckedStep::whole(const ComponentGroup& group) const {
    for (int i = 0; i < group.count; ++i)
        if (!has(group.component(i))) return false;
    return true;
}

std::string component_name(const RecordShape& shape, int j) {
    return shape.components.empty() ? formatted("x%d", j) : shape.components[static_cast<std::size_t>(j)].name;
}

StateSeries record_series(const RecordShape& shape) {
    std::vector<Component> components = shape.components;
    for (int j = static_cast<int>(components.size()); j < shape.n; ++j)
        components.push_back({component_name(shape, j), ""});
    std::vector<std::string> row_groups;
    for (const RowGroup& rows : shape.row_groups) row_groups.push_back(rows.name);
    const Innovations innovations = shape.has_innovations() ? Innovations::given : Innovations::none;
    if (!shape.has_errors) return {shape.groups, innovations, row_groups};
    return {components, shape.groups, innovations, row_groups};
}

bool figures_add_up(const double* all_series, std::size_t count) {
    constexpr double largest = 1e140;
    return std::all_of(all_series, all_series + count, [](double value) { return std::abs(value) <= largest; });
}

StepEvaluator::StepEvaluator(const RecordShape& shape, const StateSeries& all_series)
    : shape_(shape), places_(all_series), factors_(shape.groups.size()), solved_(shape.groups.size()),
      rounding_(shape.groups.size()) {
    if (shape.has_joint() || shape.has_variances || !shape.has_errors) return;
    variance_places_.resize(static_cast<std::size_t>(shape.n));
    for (std::size_t b = shape.groups.size(); b-- > 0;)  // of several groups the first one counts
        for (int i = 0; shape.source(b) == GroupSource::own && i < shape.groups[b].count; ++i)
            variance_places_[static_cast<std::size_t>(shape.groups[b].component(i))] = {static_cast<int>(b), i};
}

std::string StepEvaluator::evaluate(const CheckedStep& step, double* all_series, double* whitened) {
    unknown_.clear();
    std::ranges::fill(rounding_, 0.0);
    for (std::size_t b = 0; b < shape_.groups.size(); ++b)
        if (const std::string wrong = evaluate_group(b, step, all_series); !wrong.empty()) return wrong;
    if (shape_.has_errors) standardise(step, all_series);
    return shape_.has_innovations() ? evaluate_innovation(step, all_series, whitened) : "";
}

void StepEvaluator::forget_unknown(double* all_series) const {
    for (const std::size_t series : unknown_) all_series[series] = nan;
}

void StepEvaluator::set_unknown(std::size_t series, double* all_series) {
    all_series[series] = 0;
    unknown_.push_back(series);
}

/// Squared error and variance of a group.
void StepEvaluator::set_size_unknown(std::size_t b, double* all_series) {
    if (!shape_.has_errors) return;
    set_unknown(places_.squared_error + b, all_series);
    set_unknown(places_.variance + b, all_series);
}

template <class Matrix, class Vector>
std::string StepEvaluator::evaluate_part(std::size_t b, const Matrix& P, const Vector& e, double epsilon,
                                      double* all_series) {
    const std::string wrong = factor_checked(P, epsilon, factors_[b], rounding_[b]);
    if (!wrong.empty()) return "covariance " + wrong;
    solved_[b] = e;
    factors_[b].whiten(solved_[b]);
    all_series[b] = solved_[b].squaredNorm();
    all_series[places_.squared_error + b] = e.squaredNorm();
    all_series[places_.variance + b] = P.trace();
    if (b == 0 && shape_.has_joint())
        log_score_ = (static_cast<double>(e.size()) * log_two_pi + factors_[b].log_determinant() + all_series[b]) / 2;
    return {};
}

/// The members of the group that are in the state; of the whole state these may be fewer than it has.
void StepEvaluator::choose(const ComponentGroup& group, const CheckedStep& step) {
    members_.clear();
    for (int i = 0; i < group.count; ++i)
        if (const int j = group.component(i); step.has(j)) members_.push_back(j);
}

/// Copies the part of e and, where there is one, of P that the chosen members have.
void StepEvaluator::gather(const Eigen::VectorXd& e, const Eigen::MatrixXd& P) {
    part_e_ = e(members_);
    if (P.size() > 0) part_P_ = P(members_, members_);
}

std::string StepEvaluator::evaluate_group(std::size_t b, const CheckedStep& step, double* all_series) {
    const ComponentGroup& group = shape_.groups[b];
    const bool whole = step.whole(group);
    switch (shape_.source(b)) {
        case GroupSource::joint:
            if (whole && group.contiguous())
                return evaluate_part(b, step.P.block(group.first, group.first, group.count, group.count),
                                  step.e.segment(group.first, group.count), shape_.covariance_epsilon, all_series);
            if (!whole && b != 0) break;
            choose(group, step);
            gather(step.e, step.P);
            return evaluate_part(b, part_P_, part_e_, shape_.covariance_epsilon, all_series);
        case GroupSource::own:
            if (!whole) break;
            choose(group, step);
            gather(step.e, step.P);
            return evaluate_part(b, step.own[b], part_e_, shape_.group_epsilons[b], all_series);
        case GroupSource::variances:
            if (!whole && b != 0) break;
            return evaluate_variances(b, step, all_series);
        case GroupSource::nees:
            set_size_unknown(b, all_series);
            all_series[b] = step.nees[b];
            if (!std::isnan(step.nees[b])) return {};
            set_unknown(b, all_series);
            return {};
        case GroupSource::nothing: break;
    }
    set_unknown(b, all_series);
    set_size_unknown(b, all_series);
    return {};
}

/// Of variances alone only a single component has a NEES.
std::string StepEvaluator::evaluate_variances(std::size_t b, const CheckedStep& step, double* all_series) {
    const ComponentGroup& group = shape_.groups[b];
    double square = 0, variance = 0, score = 0;
    for (int i = 0; i < group.count; ++i) {
        const int j = group.component(i);
        if (!step.has(j)) continue;
        if (!(step.variances(j) > 0)) return step.variances(j) < 0 ? "a variance is negative" : "a variance is 0";
        square += step.e(j) * step.e(j);
        variance += step.variances(j);
        score += log_two_pi + log_of_normal(step.variances(j)) + step.e(j) * step.e(j) / step.variances(j);
    }
    if (b == 0) log_score_ = score / 2;
    all_series[places_.squared_error + b] = square;
    all_series[places_.variance + b] = variance;
    all_series[b] = square / variance;
    if (group.count > 1) set_unknown(b, all_series);
    return {};
}

void StepEvaluator::standardise(const CheckedStep& step, double* all_series) {
    for (int j = 0; j < shape_.n; ++j) {
        const std::size_t at = static_cast<std::size_t>(j), series = places_.standardised_error + at;
        const bool here = step.has(j);
        double variance = 0;
        if (here && step.P.size() > 0) variance = step.P(j, j);
        else if (here && shape_.has_variances) variance = step.variances(j);
        else if (here && !variance_places_.empty() && variance_places_[at].group >= 0)
            if (const Eigen::MatrixXd& own = step.own[static_cast<std::size_t>(variance_places_[at].group)];
                own.size() > 0)
                variance = own(variance_places_[at].index, variance_places_[at].index);
        all_series[series] = step.e(j) / std::sqrt(variance);
        if (!here || variance == 0) set_unknown(series, all_series);
    }
}

void StepEvaluator::leave_out_innovation(double* all_series, double* whitened) const {
    std::fill(whitened, whitened + shape_.m, nan);
    std::fill(all_series + places_.nis, all_series + places_.nis + 2 * (1 + shape_.row_groups.size()), 0.0);
}

std::string StepEvaluator::evaluate_innovation(const CheckedStep& step, double* all_series, double* whitened) {
    leave_out_innovation(all_series, whitened);
    all_series[places_.rows] = static_cast<double>(step.rows.size());
    innovation_rounding_ = 0;
    if (step.rows.empty()) return {};
    const std::string wrong =
        factor_checked(step.S, shape_.innovation_epsilon, innovation_factor_, innovation_rounding_);
    if (!wrong.empty()) return "innovation covariance " + wrong;
    white_ = step.nu;
    innovation_factor_.whiten(white_);
    all_series[places_.nis] = white_.squaredNorm();
    for (std::size_t i = 0; i < step.rows.size(); ++i) whitened[step.rows[i]] = white_(static_cast<Eigen::Index>(i));
    for (std::size_t g = 0; g < shape_.row_groups.size(); ++g)
        if (const std::string of_group = evaluate_row_group(g, step, all_series); !of_group.empty()) return of_group;
    return {};
}

/// The NIS of the observed rows of a group, by their part of S.
std::string StepEvaluator::evaluate_row_group(std::size_t g, const CheckedStep& step, double* all_series) {
    members_.clear();
    for (std::size_t i = 0; i < step.rows.size(); ++i)
        if (std::ranges::find(shape_.row_groups[g].rows, step.rows[i]) != shape_.row_groups[g].rows.end())
            members_.push_back(static_cast<int>(i));
    const auto m = static_cast<Eigen::Index>(members_.size());
    all_series[places_.rows + 2 * (g + 1)] = static_cast<double>(m);
    if (m == 0) return {};
    gather(step.nu, step.S);
    double rounding = 0;  // no more than that of all rows
    const std::string wrong = factor_checked(part_P_, shape_.innovation_epsilon, innovation_factor_, rounding);
    if (!wrong.empty()) return "innovation covariance " + wrong;
    innovation_factor_.whiten(part_e_);
    all_series[places_.nis + 2 * (g + 1)] = part_e_.squaredNorm();
    return {};
}

}  // namespace credence
