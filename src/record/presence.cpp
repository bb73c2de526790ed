#include "record/presence.hpp"

#include "base/nan.hpp"
#include "record/source.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

std::string in_ticks(const std::string& name) { return "`" + name + "`"; }

}  // namespace

PresenceChecker::PresenceChecker(const RecordShape& shape)
    : shape_(shape), components_(static_cast<std::size_t>(shape.n)), groups_(shape.groups.size()) {
    for (const ComponentGroup& group : shape.groups) members_.push_back(members_of(group));
}

Presence PresenceChecker::check(const RecordStep& step, CheckedStep& checked) {
    if (step.step == 0) {
        std::ranges::fill(components_, Stay::before);
        std::ranges::fill(groups_, Stay::before);
    }
    if (!shape_.covers(step.trial, step.step) || !exists(step)) return Presence::absent;
    checked.broken = read(step, checked);
    return checked.broken.empty() ? Presence::there : Presence::broken;
}

/// Whether an error, a covariance or a NEES has a number.
bool PresenceChecker::exists(const RecordStep& step) const {
    const std::ptrdiff_t n = shape_.n;
    if (step.error != nullptr && any_number(step.error, n)) return true;
    if (step.covariance != nullptr && any_number(step.covariance, shape_.has_variances ? n : n * n)) return true;
    for (std::size_t b = 0; b < step.own.size(); ++b) {
        const std::ptrdiff_t d = shape_.source(b) == GroupSource::own ? shape_.groups[b].count : 1;
        if (step.own[b] != nullptr && any_number(step.own[b], d * d)) return true;
    }
    return false;
}

std::string PresenceChecker::read(const RecordStep& step, CheckedStep& checked) {
    checked.own.resize(shape_.groups.size());
    checked.nees.assign(shape_.groups.size(), nan);
    std::string wrong;
    if (shape_.has_errors) wrong = read_errors(step, checked);
    if (wrong.empty() && shape_.has_joint()) wrong = read_covariance(step, checked);
    if (wrong.empty() && shape_.has_variances) wrong = read_variances(step, checked);
    for (std::size_t b = 0; b < shape_.groups.size() && wrong.empty(); ++b) {
        if (shape_.source(b) == GroupSource::own) wrong = read_own(step, b, checked);
        if (shape_.source(b) == GroupSource::nees) wrong = read_nees(step, b, checked);
    }
    if (wrong.empty() && step.truth_covariance != nullptr) use_truth(step, checked);
    return wrong.empty() && shape_.has_innovations() ? read_innovation(step, shape_, checked) : wrong;
}

/// Says what is wrong where something comes back that had left.
std::string PresenceChecker::follow(std::vector<Stay>& stays, std::size_t at, bool here,
                                    const std::string& what) const {
    if (here && stays[at] == Stay::after) return what + " is a number again, after it was NaN";
    if (here) stays[at] = Stay::in;
    else if (stays[at] == Stay::in) stays[at] = Stay::after;
    return {};
}

std::string PresenceChecker::read_errors(const RecordStep& step, CheckedStep& checked) {
    const auto n = static_cast<std::size_t>(shape_.n);
    checked.e.resize(shape_.n);
    checked.here.resize(n);
    here_.clear();
    for (std::size_t j = 0; j < n; ++j) {
        const bool here = !std::isnan(step.error[j]);
        checked.here[j] = here;
        checked.e(static_cast<Eigen::Index>(j)) = here ? step.error[j] : 0;
        if (here) here_.push_back(static_cast<int>(j));
    }
    if (here_.empty()) return "the error is NaN, and the covariance is not";
    if (!checked.e.allFinite()) return "the error is not finite";
    for (std::size_t j = 0; j < n; ++j)
        if (std::string wrong = follow(components_, j, checked.here[j],
                                       "the error of " + in_ticks(component_name(shape_, static_cast<int>(j))));
            !wrong.empty())
            return wrong;
    return {};
}

/// What is wrong with the NaN of a matrix over these components: the rows and columns of those that are in the state
/// are numbers, and the others are NaN.
std::string PresenceChecker::matrix_trouble(const double* values, const std::vector<int>& components,
                                            const CheckedStep& checked, const std::string& of) const {
    const std::size_t size = components.size();
    const auto here = [&](std::size_t i) { return checked.here[static_cast<std::size_t>(components[i])] != 0; };
    for (std::size_t i = 0; i < size; ++i) {
        const std::string name = component_name(shape_, components[i]);
        if (here(i) && std::isnan(values[i * size + i]))
            return of + " of " + in_ticks(name) + " is NaN, and the error is not";
        for (std::size_t j = 0; j < size; ++j)
            if (!(here(i) && here(j)) && !std::isnan(values[i * size + j]))
                return "the error of " + in_ticks(here(i) ? component_name(shape_, components[j]) : name) +
                       " is NaN, and " + of + " is not";
    }
    return {};
}

std::string PresenceChecker::read_covariance(const RecordStep& step, CheckedStep& checked) {
    if (!any_number(step.covariance, std::ptrdiff_t{shape_.n} * shape_.n))
        return "the covariance is NaN, and the error is not";
    if (std::string wrong = matrix_trouble(step.covariance, members_[0], checked, "the covariance"); !wrong.empty())
        return wrong;
    const bool all = here_.size() == checked.here.size();
    if (!read_symmetric("covariance", step, step.covariance, shape_.n, here_, shape_.covariance_epsilon,
                        all ? checked.P : part_))
        return "the covariance is not finite";
    if (all) return {};
    checked.P.setZero(shape_.n, shape_.n);
    checked.P(here_, here_) = part_;
    return {};
}

std::string PresenceChecker::read_variances(const RecordStep& step, CheckedStep& checked) {
    checked.variances.setZero(shape_.n);
    for (int j = 0; j < shape_.n; ++j) {
        const bool here = checked.here[static_cast<std::size_t>(j)] != 0;
        const std::string name = in_ticks(component_name(shape_, j));
        if (here && std::isnan(step.covariance[j])) return "the variance of " + name + " is NaN, and the error is not";
        if (!here && !std::isnan(step.covariance[j]))
            return "the error of " + name + " is NaN, and the variance is not";
        if (here) checked.variances(j) = step.covariance[j];
    }
    return checked.variances.allFinite() ? "" : "a variance is not finite";
}

/// Adds the covariance of the truth's errors to those of the filter, or subtracts it.
void PresenceChecker::use_truth(const RecordStep& step, CheckedStep& checked) {
    constexpr double rounding = 1e-6;
    const std::string name = "truth_covariance";
    bool fits = read_symmetric(name, step, step.truth_covariance, shape_.n, here_, rounding / 16, part_);
    if (shape_.truth == TruthUse::beside && fits && !part_.isZero(0)) {
        Eigen::MatrixXd padded = part_;
        padded.diagonal() = (1 + rounding) * part_.diagonal().array() +
                            rounding * rounding * part_.diagonal().cwiseAbs().maxCoeff();
        fits = CholeskyFactor(padded).succeeded();
    }
    if (!fits)
        throw RecordError(record_place(name),
                          "trial " + std::to_string(step.trial) + ", step " + std::to_string(step.step) +
                              " (both counted from 0) is no covariance: it is not finite, or has a negative eigenvalue",
                          "Write that of the truth's errors in the chart and units of `error`, 0 where it is exact");
    checked.R.setZero(shape_.n, shape_.n);
    checked.R(here_, here_) = part_;
    if (shape_.truth == TruthUse::beside) return;
    const double sign = shape_.truth == TruthUse::added ? 1 : -1;
    if (checked.P.size() > 0) checked.P += sign * checked.R;
    if (shape_.has_variances) checked.variances += sign * checked.R.diagonal();
    for (std::size_t b = 0; b < checked.own.size(); ++b)
        if (checked.own[b].size() > 0) checked.own[b] += sign * checked.R(members_[b], members_[b]);
}

std::string PresenceChecker::read_own(const RecordStep& step, std::size_t b, CheckedStep& checked) {
    const ComponentGroup& group = shape_.groups[b];
    const std::ptrdiff_t d = group.count;
    checked.own[b].resize(0, 0);
    if (!checked.whole(group) && !any_number(step.own[b], d * d)) return {};
    if (std::string wrong =
            matrix_trouble(step.own[b], members_[b], checked, "the covariance of group " + in_ticks(group.name));
        !wrong.empty())
        return wrong;
    if (!checked.whole(group)) return {};
    return read_symmetric("group/" + group.name + "/covariance", step, step.own[b], group.count,
                          counted_up(group.count), shape_.group_epsilons[b], checked.own[b])
               ? ""
               : "the covariance of group " + in_ticks(group.name) + " is not finite";
}

std::string PresenceChecker::read_nees(const RecordStep& step, std::size_t b, CheckedStep& checked) {
    const ComponentGroup& group = shape_.groups[b];
    const double nees = *step.own[b];
    const bool here = !std::isnan(nees);
    const std::string of = b == 0 ? "the NEES" : "the NEES of " + in_ticks(group.name);
    checked.nees[b] = nees;
    if (!shape_.has_errors) {
        if (std::string wrong = follow(groups_, b, here, of); !wrong.empty()) return wrong;
    } else if (here != checked.whole(group)) {
        return here ? of + " is a number, and an error of the group is NaN" : of + " is NaN, and the error is not";
    }
    if (here && !std::isfinite(nees)) return of + " is not finite";
    return here && nees < 0 ? of + " is negative" : "";
}

}  // namespace credence
