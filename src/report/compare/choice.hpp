#pragma once
// Selects the arms, and their files, that are compared.

#include "report/compare/compare.hpp"
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// Two arms to be compared, and the files that they are of.
struct ChosenPair {
    ComparedArm a, b;
    const StudyFile &file_a, &file_b;
};

/// The names of files: their stems, or their paths where two stems are the same.
std::vector<std::string> file_labels(const std::vector<std::string>& paths);

/// Checks that the files can be compared, and lists the pairs that were chosen. Scenarios without a partner are
/// added to `left_out`, with the reason. Throws InputError where no pair is left.
std::vector<ChosenPair> chosen_pairs(const std::vector<StudyFile>& files, const std::optional<ArmsChoice>& choice,
                                     std::vector<std::string>& left_out);

/// Throws InputError where the files' root seeds differ.
void check_same_draws(const std::vector<StudyFile>& files);

/// Throws InputError naming the first key by which the scenarios of two files have different truths or draws.
void check_same_world(const ChosenPair& pair);

/// Throws InputError naming a column that is in other units in the files of a pair.
void check_same_units(const ChosenPair& pair);

/// Whether the scenarios of a pair differ in a sensor: they are different worlds, which share their draws.
bool of_different_worlds(const ComparedPair& pair);

/// The keys in which two resolved scenarios differ, except for titles and published values.
std::vector<KeyDifference> shown_differences(const Scenario& a, const Scenario& b);

}  // namespace credence
