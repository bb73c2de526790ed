#pragma once
// Words that every rendering of a comparison shares.

#include <credence/compare.hpp>

#include <string>

namespace credence {

/// What is compared, and what the intervals mean.
std::string compare_head(const CompareReport& report);

/// Failed and diverged trials, studies that are not complete, scenarios that are left out; a line each.
std::string compare_notes(const CompareReport& report);

/// One sentence on the first figure.
std::string conclusion_text(const ComparedPair& pair);

/// What is compared, where that is not plain from the arms' names; the scenario's name and title in the first line.
std::string pair_head(const ComparedPair& pair);

}  // namespace credence
