#pragma once
// Room 13: words that every rendering of a report shares.

#include <credence/report.hpp>

#include <string>
#include <vector>

namespace credence {

/// A line of why an arm has its verdict: a head, and what is listed behind it.
struct Reason {
    std::string head;
    std::vector<std::string> parts;
};

/// Why an arm has its verdict: the worst of what was found, notes, and what would decide.
std::vector<Reason> reasons_of(const ArmReport& arm);

/// What is missing where no trial is kept.
inline const char* const no_trials_note =
    "only totals are kept: medians and distributions need the trials (credence run --keep trials).";

/// What is said before anything else: failed and diverged trials, troubles of a record, a study that is not complete or
/// keeps no trials.
std::vector<std::string> warnings_of(const Report& report);

/// The figure of that name; the first one where there is none.
const FigureReport& figure_named(const std::vector<FigureReport>& figures, const std::string& name);

/// A figure's name in words, with its unit.
std::string figure_title(const std::string& figure, const std::string& unit);

/// The blocks worth a line: those of several parts, and the features (or whatever comes in numbers) that are farthest
/// off.
std::vector<const BlockEvidence*> shown_blocks(const Evidence& evidence);

/// Of the values that are known.
double mean_of(const std::vector<double>& values);

/// The step whose NEES is farthest from chi-square.
struct WorstShape {
    int step = 0, known = 0;     ///< known: steps with a distance
    double distance = 0, p = 0;  ///< p corrected for all of them
};
WorstShape worst_shape(const ShapeEvidence& shape);

/// Lags whose correlation is outside their joint bound.
int lags_outside(const std::vector<Whiteness>& whiteness);

/// `3 of 19`
std::string of_steps(int outside, int steps);

}  // namespace credence
