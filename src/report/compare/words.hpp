#pragma once
// Texts that every format of a comparison uses.

#include "report/compare/compare.hpp"

#include <string>

namespace credence {

/// What is compared, and the meaning of the intervals.
std::string compare_head(const CompareReport& report);

/// Failed and diverged trials, studies that are not complete, scenarios that are left out; a line each.
std::string compare_notes(const CompareReport& report);

/// One sentence on the first column, and the others that differ.
std::string conclusion_text(const ComparedPair& pair);

/// What is compared, where the arms' names do not show it; the scenario's name and title in the first line.
std::string pair_head(const ComparedPair& pair);

}  // namespace credence
