#include "record/alike.hpp"

#include <algorithm>
#include <map>

namespace credence {

std::size_t pose_group(const RecordShape& shape) {
    const auto found = std::ranges::find(shape.groups, "pose", &ComponentGroup::name);
    return found == shape.groups.end() ? 0 : static_cast<std::size_t>(found - shape.groups.begin());
}

ComponentGroup alike(const RecordShape& shape, const ComponentGroup& group) {
    if (shape.components.empty()) return group;
    const auto unit = [&](int i) { return shape.components[static_cast<std::size_t>(group.component(i))].unit; };
    std::map<std::string, ComponentGroup> by_unit;
    const ComponentGroup* most = nullptr;
    for (int i = 0; i < group.count; ++i) {
        if (unit(i).empty()) return group;
        ComponentGroup& same = by_unit[unit(i)];
        same.components.push_back(group.component(i));
        ++same.count;
        if (most == nullptr || same.count > most->count) most = &same;
    }
    return by_unit.size() == 1 ? group : *most;
}

std::string unit_of_squares(const RecordShape& shape, std::size_t group) {
    return shape.components.empty() ? "unit of error squared"
                                    : squared_unit(shape.components, alike(shape, shape.groups[group]));
}

AlikeSums::AlikeSums(const RecordShape& shape)
    : of_state_(alike(shape, shape.groups.front())), of_pose_(alike(shape, shape.groups[pose_group(shape)])) {
    const auto steps = static_cast<std::size_t>(shape.has_errors ? shape.steps : 0);
    if (of_state_.count < shape.n) variances_.resize(steps);
    if (of_pose_.count < shape.groups[pose_group(shape)].count) errors_.resize(steps);
}

void AlikeSums::keep(std::size_t k, const CheckedStep& step) {
    const auto sum = [](const ComponentGroup& group, const auto& square) {
        double sum = 0;
        for (int i = 0; i < group.count; ++i) sum += square(group.component(i));
        return sum;
    };
    if (!variances_.empty() && step.P.size() > 0)
        variances_[k] = sum(of_state_, [&](int j) { return step.P(j, j); });
    else if (!variances_.empty() && step.variances.size() > 0)
        variances_[k] = sum(of_state_, [&](int j) { return step.variances(j); });
    if (!errors_.empty()) errors_[k] = sum(of_pose_, [&](int j) { return step.e(j) * step.e(j); });
}

}  // namespace credence
