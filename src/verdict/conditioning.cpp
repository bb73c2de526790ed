// Conditioning: what rounding may have done to NEES, from the mean covariance of the detailed trials, and of a record
// from the covariances of its steps.

#include "numeric/decompositions.hpp"

#include <algorithm>
#include <cmath>
#include <credence/detail/exact_sum.hpp>
#include <utility>
#include <vector>

#include "base/nan.hpp"
#include "statistics/moments/trial_moments.hpp"
#include "verdict/evidence_parts.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

/// The sum over trials and steps of the standardised P: what is absent counts as 0. The sum is exact, because the
/// rounding of thousands of additions would hide the eigenvalues that are looked for.
Eigen::MatrixXd sum_of_covariances(const TrialMoments& moments) {
    const int n = moments.components;
    std::vector<ExactSum> sums(static_cast<std::size_t>(triangle_size(n)));
    for (std::size_t i = 0; i < moments.trials(); ++i)
        for (std::size_t place = 0; place < sums.size(); ++place)
            if (const double value = moments.C(i)[place]; !std::isnan(value)) sums[place].add(value);
    Eigen::VectorXd rounded(triangle_size(n));
    for (Eigen::Index place = 0; place < rounded.size(); ++place)
        rounded[place] = sums[static_cast<std::size_t>(place)].rounded();
    return symmetric(rounded, n);
}

void set_unknown(std::vector<double>& values) { std::fill(values.begin(), values.end(), nan); }

void leave_out(BandedRatio& ratio) {
    set_unknown(ratio.ratio);
    ratio.observed = ratio.outside = ratio.outside_simultaneous = 0;
}

/// All numbers of a group that rest on its NEES.
void leave_out(GroupEvidence& group) {
    const Moments unknown{0, nan, nan, nan};
    group.run = group.without_diverged = unknown;
    std::fill(group.step.begin(), group.step.end(), unknown);
    leave_out(group.anees);
    set_unknown(group.variance_ratio);
    for (Coverage& level : group.coverage) {
        set_unknown(level.share);
        std::fill(level.interval.begin(), level.interval.end(), Interval{nan, nan});
        level.over_steps = nan;
    }
}

/// What rests on the NEES of the whole state beside its group.
void leave_out_whole_state(Evidence& evidence) {
    set_unknown(evidence.distribution.distance);
    set_unknown(evidence.distribution.p);
    evidence.credibility.nci = evidence.credibility.inclination = nan;
    for (Credibility& step : evidence.credibility.step) step.nci = step.inclination = nan;
    evidence.worst = {};
}

}  // namespace

void add_rounding(const ArmResults& arm, Evidence& evidence) {
    for (std::size_t g = 0; g < arm.totals.rounding.size(); ++g) evidence.groups[g].rounding = arm.totals.rounding[g];
    if (!evidence.moments || !evidence.joint || evidence.moments->components > largest_moment_state) return;
    const Eigen::MatrixXd C = sum_of_covariances(*evidence.moments);
    for (GroupEvidence& group : evidence.groups)
        group.rounding = std::max(group.rounding,
                                  rounding_bound(C(group.components, group.components), evidence.epsilon));
}

bool is_rounded(const GroupEvidence& group, const Limits& limits) {
    return group.rounding > rounding_share * limits.margin;
}

void leave_out_rounded(Evidence& evidence, const Limits& limits) {
    for (GroupEvidence& group : evidence.groups) {
        if (!is_rounded(group, limits)) continue;
        if (&group == &evidence.groups.front()) leave_out_whole_state(evidence);
        leave_out(group);
    }
}

void show_finite_trials(Evidence& evidence, const Limits& limits) {
    if (!evidence.of_finite) return;
    const Evidence& all = *evidence.of_finite;
    const auto left_out = std::exchange(evidence.groups, all.groups);
    for (std::size_t g = 0; g < left_out.size(); ++g) evidence.groups[g].without_diverged = left_out[g].run;
    std::ranges::copy(all.charts, evidence.charts.begin());
    evidence.nis = all.nis;
    evidence.bias = all.bias;
    evidence.of_finite.reset();
    leave_out_rounded(evidence, limits);
}

}  // namespace credence
