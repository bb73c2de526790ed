#pragma once
// The means that a goal refers to in a given study.

#include "study/stopping.hpp"

#include <cstddef>
#include <vector>

namespace credence {

/// A mean that a goal asks for: of a column of one arm, or of the differences between two.
struct StoppingSubject {
    const ScenarioResults* results;
    std::size_t column;
    const ArmResults* arm;
    const ArmResults* subtracted;  ///< null: not a difference
};

/// Throws as check_goals does; at least one.
std::vector<StoppingSubject> subjects_of(const StoppingGoal& goal, const Study& study);

}  // namespace credence
