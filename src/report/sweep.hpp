#pragma once
// A report's sweeps, and the values of its arms and pairs at their points.

#include <credence/report.hpp>

#include "report/sweep_grid.hpp"
#include "report/table.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// A report organised by the points of its sweeps.
class SweptReport {
public:
    explicit SweptReport(const Report& report);

    const Report& report() const { return report_; }
    const std::vector<Grid>& grids() const { return grids_; }
    const std::string& scenario(const GridPoint& point) const { return report_.scenarios[point.scenario].name; }
    /// Nothing where the point does not have the arm or the pair.
    const ArmReport* arm(const GridPoint& point, const std::string& name) const;
    const Comparison* pair(const GridPoint& point, const std::string& name) const;
    /// Names of the arms and of the pairs of all points, in the order of their first appearance.
    std::vector<std::string> arm_names(const Grid& grid) const;
    std::vector<std::string> pair_names(const Grid& grid) const;
    /// Whether the point has a section on a page.
    bool points_have_sections() const { return points_have_sections_; }
    /// Whether the file has trials of a point.
    bool has_run(const GridPoint& point) const { return run_.count(scenario(point)) > 0; }
    /// Whether a scenario is a point of a sweep.
    static bool swept(const Scenario& scenario) { return !scenario.sweep.at.empty(); }

private:
    using Key = std::pair<std::string, std::string>;

    std::set<std::string> names_of_points(const Grid& grid) const;

    const Report& report_;
    std::vector<Grid> grids_;
    std::map<Key, const ArmReport*> arms_;
    std::map<Key, const Comparison*> pairs_;
    std::set<std::string> run_;
    bool points_have_sections_ = true;
};

/// A quantity of a point as its tables and curves show it.
struct SweptColumn {
    std::string name, unit;
    Summary summary;
};

/// The quantities that tables and curves show of an arm, in their order: NEES, NIS, trace(P), log score and a
/// user's own columns, as far as it has them.
std::vector<SweptColumn> swept_columns(const ArmReport& arm);
/// Those of a pair: the gain by planning.
std::vector<SweptColumn> swept_columns(const Comparison& pair);

/// Columns that only the CSV of a study with sweeps has: the swept scenario, and every swept key. Blank for a scenario
/// without them.
class SweepColumns {
public:
    explicit SweepColumns(const Report& report);
    std::vector<Cell> heads() const;
    std::vector<Cell> cells(const std::string& scenario) const;

private:
    std::map<std::string, SweepPoint> places_;
    std::vector<std::string> keys_;
};

/// The names of the scenarios that are points of sweeps.
std::set<std::string> swept_scenarios(const Report& report);

/// Whether a page has sections for the points of sweeps: only where there are few, because the page would be too long.
bool points_have_sections(const std::set<std::string>& swept);

/// The columns' means and the verdict of an arm at every point of a grid, and those of a pair.
Table arm_table(const SweptReport& swept, const Grid& grid, const std::string& name);
Table pair_table(const SweptReport& swept, const Grid& grid, const std::string& name);

/// The sweeps as text tables.
std::string sweep_text(const Report& report);

}  // namespace credence
