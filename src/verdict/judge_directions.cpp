// The verdict's directions: which combination of the state has errors that P does not allow for.

#include "statistics/bias.hpp"
#include "verdict/judgement.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace credence {

namespace {

/// `0.71 x - 0.71 y`
std::string name_of(const Direction& direction, const std::vector<BiasEvidence>& components) {
    std::string text = direction.approximate ? "about " : "";
    for (std::size_t i = 0; i < direction.entries.size(); ++i) {
        const DirectionEntry& entry = direction.entries[i];
        char weight[32];
        std::snprintf(weight, sizeof weight, "%.2f", std::abs(entry.weight));
        text += i == 0 ? (entry.weight < 0 ? "-" : "") : entry.weight < 0 ? " - " : " + ";
        const auto j = static_cast<std::size_t>(entry.component);
        text += std::string(weight) + " " + (j < components.size() ? components[j].component : "x" + std::to_string(j));
    }
    return text;
}

/// Ratios of the generalised eigenvectors of sum S against sum C, rising; none where C is singular.
std::vector<double> spectrum_of(const FoldSums& sums) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(sums.all_S(), sums.all_C(), Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success) return {};
    return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

std::string why_unknown(const Evidence& evidence) {
    const int size = evidence.groups.front().dimension;
    if (size > largest_moment_state)
        return "directions are computed for states of up to " + std::to_string(largest_moment_state) + " components, and this has " +
               std::to_string(size);
    if (!evidence.moments) return "directions are not in this file";
    return "directions need " + std::to_string(static_cast<int>(direction_trials)) + " trials";
}

/// A group's directions, and the findings in them.
void judge_group(const Evidence& evidence, const GroupEvidence& group, const GroupMoments& moments, const FoldSums& sums,
                 double level, Judgement& judgement) {
    const GroupDirections found = find_directions(moments, sums, level, {judgement.limits().margin, judgement.limits().direction});
    if (found.left_out > 0 && group.name != evidence.groups.front().name)
        judgement.not_shown("conditioning: P of " + group.name + " cannot be told from singular in " +
                            std::to_string(found.left_out) + " directions");
    if (found.state != GroupDirections::State::known) return;
    const auto add = [&](Side side, const Direction& direction, std::vector<DirectionOfGroup>& all) {
        all.push_back({group.name, name_of(direction, evidence.bias), direction.ratio.mean, direction.bounds});
        if (direction.finding)
            judgement.add(side, {"", group.name, "direction " + all.back().name, direction.ratio.mean, direction.bounds,
                                 "squared error over P's"});
    };
    add(Side::above, found.largest, judgement.directions.largest);
    add(Side::below, found.smallest, judgement.directions.smallest);
}

void accept_state(const GroupMoments& state, const FoldSums& sums, Judgement& judgement) {
    const DirectionsAccepted accepted = accept_directions(state, sums, {judgement.limits().margin, judgement.limits().direction});
    judgement.directions.range = accepted.bounds;
    if (accepted.left_out > 0)
        judgement.not_shown("conditioning: P cannot be told from singular in " + std::to_string(accepted.left_out) + " directions");
    judgement.accept(accepted.acceptance, "directions");
}

}  // namespace

std::vector<int> uncertain_components(const Evidence& evidence, const std::vector<int>& components) {
    std::vector<int> uncertain;
    for (const int j : components) {
        const auto place = static_cast<std::size_t>(j);
        if (place >= evidence.bias.size() || evidence.bias[place].largest_error > rounding_error) uncertain.push_back(j);
    }
    return uncertain;
}

void judge_directions(const Evidence& evidence, Judgement& judgement) {
    if (evidence.groups.empty() || evidence.groups.front().dimension < 2 || !evidence.joint) return;
    std::vector<const GroupEvidence*> groups;
    for (const GroupEvidence& group : evidence.groups)
        if (uncertain_components(evidence, group.components).size() >= 2) groups.push_back(&group);
    if (groups.empty()) return;
    if (!evidence.moments || static_cast<double>(evidence.moments->trials()) < direction_trials) {
        judgement.directions.unknown = why_unknown(evidence);
        return judgement.not_shown(judgement.directions.unknown);
    }
    judgement.directions.trials = static_cast<double>(evidence.moments->trials());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const GroupMoments moments = group_moments(*evidence.moments, uncertain_components(evidence, groups[g]->components));
        const FoldSums sums = fold_sums(moments);
        const double level = level_of_group(levels::direction, static_cast<int>(g), static_cast<int>(groups.size())) / 2;
        judge_group(evidence, *groups[g], moments, sums, level, judgement);
        if (g > 0) continue;
        judgement.directions.spectrum = spectrum_of(sums);
        accept_state(moments, sums, judgement);
    }
}

}  // namespace credence
