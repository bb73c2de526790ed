#pragma once
// The names of the datasets of an arm.

#include <credence/study.hpp>

#include <string>
#include <vector>

namespace credence {

/// Names of the datasets in the group of the next arm.
std::vector<std::string> arm_links(const ScenarioResults& results);

/// Throws InputError where two datasets of an arm would have one name: those of columns, groups and components of a
/// user's own world.
void refuse_clashing_links(const Study& study);

}  // namespace credence
