// The verdict's directions: which combination of the state has errors that P does not allow for.

#include "base/formatted.hpp"
#include "statistics/mean_bounds.hpp"
#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace credence {

namespace {

std::string component_name(int j, const std::vector<BiasEvidence>& components) {
    const auto place = static_cast<std::size_t>(j);
    return place < components.size() ? components[place].component : "x" + std::to_string(j);
}

/// `0.47 x - 0.79 y + 0.39 v …`: the four largest shares, in the order of the components; `…` where others are left
/// out.
std::string name_of(const Direction& direction, const std::vector<BiasEvidence>& components) {
    constexpr std::size_t most = 4;
    std::vector<double> sizes;
    for (const DirectionEntry& entry : direction.entries) sizes.push_back(std::abs(entry.weight));
    std::ranges::sort(sizes, std::greater());
    const double least = sizes.size() > most ? sizes[most - 1] : 0;
    std::string text;
    for (const DirectionEntry& entry : direction.entries) {
        if (std::abs(entry.weight) < least) continue;
        text += text.empty() ? (entry.weight < 0 ? "-" : "") : entry.weight < 0 ? " - " : " + ";
        text += formatted("%.2f ", std::abs(entry.weight)) + component_name(entry.component, components);
    }
    return text + (direction.approximate || sizes.size() > most ? " …" : "");
}

/// The loadings of a direction with the names of components.
std::vector<Loading> loadings_of(const Direction& direction, const std::vector<BiasEvidence>& components) {
    std::vector<Loading> loadings;
    for (const DirectionEntry& entry : direction.entries)
        loadings.push_back({component_name(entry.component, components), entry.weight});
    return loadings;
}

/// Withholds `consistent`, because there are no directions.
void leave_out_directions(const Evidence& evidence, Judgement& judgement) {
    const int size = evidence.groups.front().dimension;
    std::string& why = judgement.directions.unknown;
    why = "directions need " + std::to_string(static_cast<int>(direction_trials)) + " " + evidence.units();
    if (!evidence.moments) why = "directions are not in this file";
    if (size > largest_moment_state)
        why = "directions are computed for states of up to " + std::to_string(largest_moment_state) +
              " components, and this has " + std::to_string(size);
    judgement.not_shown(why, evidence.moments != nullptr);
}

DirectionLimits limits_of(const Evidence& evidence, const Judgement& judgement) {
    return {judgement.limits().margin, evidence.epsilon, static_cast<double>(evidence.steps_together()),
            evidence.segments.count};
}

/// A group's directions, and the findings in them.
void judge_group(const Evidence& evidence, const GroupEvidence& group, const GroupMoments& moments,
                 const FoldSums& sums, double level, Judgement& judgement) {
    GroupDirections found = find_directions(moments, sums, level, limits_of(evidence, judgement));
    if (found.state != GroupDirections::State::known) return;
    if (evidence.has_offsets()) found.smallest.finding = false;
    if (evidence.has_offsets() && evidence.centred) {
        const GroupMoments centred = group_moments(*evidence.centred, moments.components);
        const GroupDirections about =
            find_directions(centred, fold_sums(centred), level, limits_of(evidence, judgement));
        if (about.state != GroupDirections::State::known) return;
        found.largest = about.largest;
    }
    const auto add = [&](Side side, const Direction& direction, std::vector<DirectionOfGroup>& all) {
        all.push_back({group.name, name_of(direction, evidence.bias), direction.ratio.mean, direction.bounds, level,
                       loadings_of(direction, evidence.bias)});
        const std::string &name = all.back().name, measure = "squared error over P's";
        if (direction.finding)
            return judgement.add(side, {Subject::direction, fault_of(side), group.name, name, direction.ratio.mean,
                                        direction.bounds, measure});
        const std::optional<Suspicion> looks = suspicion_of(direction.ratio, level, judgement.limits().margin);
        if (looks && looks->what == fault_of(side))
            judgement.suspect(
                {Subject::direction, looks->what, group.name + ", " + name, looks->value, measure, looks->trials});
    };
    add(Side::above, found.largest, judgement.directions.largest);
    add(Side::below, found.smallest, judgement.directions.smallest);
}

void accept_state(const Evidence& evidence, const GroupMoments& state, const FoldSums& sums, Judgement& judgement) {
    if (sums.trials() < direction_trials)
        return judgement.not_shown(
            "directions need " + std::to_string(static_cast<int>(direction_trials)) +
                " " + evidence.units() + " in which every two components are in the state together, and there are " +
                std::to_string(static_cast<int>(sums.trials())),
            true);
    const DirectionsAccepted accepted = accept_directions(state, sums, limits_of(evidence, judgement));
    judgement.directions.range = accepted.bounds;
    judgement.reach(&Reached::direction,
                    accepted.left_out > 0 ? std::numeric_limits<double>::infinity() : accepted.shown);
    judgement.directions.spectrum = accepted.spectrum;
    if (accepted.left_out > 0)
        judgement.not_shown("conditioning: P cannot be distinguished from a singular one in " +
                                std::to_string(accepted.left_out) +
                                (accepted.left_out == 1 ? " direction" : " directions"),
                            false);
    judgement.accept(accepted.shown <= judgement.limits().direction, "directions");
}

}  // namespace

std::vector<int> uncertain_components(const Evidence& evidence, const std::vector<int>& components) {
    std::vector<int> uncertain;
    for (const int j : components) {
        const auto place = static_cast<std::size_t>(j);
        const bool known = place < evidence.bias.size();
        if (known && evidence.trials > 0 && !(evidence.bias[place].run.count > 0)) continue;  // no trial has it
        if (!known || evidence.bias[place].largest_error > rounding_error) uncertain.push_back(j);
    }
    return uncertain;
}

void judge_directions(const Evidence& evidence, Judgement& judgement) {
    if (evidence.groups.empty() || evidence.groups.front().dimension < 2 || !evidence.joint) return;
    std::vector<const GroupEvidence*> groups;
    for (const GroupEvidence& group : evidence.groups)
        if (uncertain_components(evidence, group.components).size() >= 2) groups.push_back(&group);
    if (groups.empty()) return;
    if (!evidence.moments || static_cast<double>(evidence.moments->trials()) < direction_trials)
        return leave_out_directions(evidence, judgement);
    judgement.directions.trials = static_cast<double>(evidence.moments->trials());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const GroupMoments moments =
            group_moments(*evidence.moments, uncertain_components(evidence, groups[g]->components));
        const FoldSums sums = fold_sums(moments);
        const double level =
            level_of_group(levels::direction, static_cast<int>(g), static_cast<int>(groups.size())) / 2;
        judge_group(evidence, *groups[g], moments, sums, level, judgement);
        if (g == 0) accept_state(evidence, moments, sums, judgement);
    }
}

}  // namespace credence
