#pragma once
// A report's sweeps: the scenarios that are points of one, and the tables by point, for text and page alike.

#include <credence/report.hpp>

#include "report/table.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace credence {

/// Whether a scenario is a point of a sweep.
inline bool is_swept(const Scenario& scenario) { return !scenario.sweep.at.empty(); }

/// The names of the scenarios that are points of sweeps.
std::set<std::string> swept_scenarios(const Report& report);

/// Whether a page has sections for the points of sweeps: only where there are few, because the page would be too long.
bool points_have_sections(const std::set<std::string>& swept);

/// The points of one scenario under the same swept keys.
struct Grid {
    std::string of;
    std::vector<std::string> keys;
    std::map<std::string, const Scenario*> points;  ///< by name
};

/// The grids of a study, in the order of their first points.
std::vector<Grid> grids_of(const Report& report);

/// The columns' means of an arm, with its verdict, or of a pair, at every point of a grid.
struct SweptTable {
    std::string head;
    Table table;
};

/// Of every arm, then of every pair, in the order in which they appear; the points are in the study's order.
std::vector<SweptTable> tables_of(const Report& report, const Grid& grid);

}  // namespace credence
