#pragma once
// A report's grids, and what its arms and pairs have at their points.

#include <credence/report.hpp>

#include "report/sweep_grid.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// The report as grids of points.
class SweptReport {
public:
    explicit SweptReport(const Report& report);

    const Report& report() const { return report_; }
    const std::vector<Grid>& grids() const { return grids_; }
    const std::string& scenario(const GridPoint& point) const { return report_.scenarios[point.scenario].name; }
    /// Nothing where the point lacks the arm or the pair.
    const ArmReport* arm(const GridPoint& point, const std::string& name) const;
    const Comparison* pair(const GridPoint& point, const std::string& name) const;
    /// Names of the arms and of the pairs of all points, in the order in which they come.
    std::vector<std::string> arm_names(const Grid& grid) const;
    std::vector<std::string> pair_names(const Grid& grid) const;
    /// Whether a scenario is a point of a grid.
    static bool swept(const Scenario& scenario) { return !scenario.sweep.at.empty(); }

private:
    using Key = std::pair<std::string, std::string>;

    std::set<std::string> names_of_points(const Grid& grid) const;

    const Report& report_;
    std::vector<Grid> grids_;
    std::map<Key, const ArmReport*> arms_;
    std::map<Key, const Comparison*> pairs_;
};

/// A figure of a point as its tables and curves show it.
struct SweptColumn {
    std::string name, unit;
    Summary summary;
};

/// The figures that tables and curves show of an arm, in their order: NEES, NIS and trace(P), as far as it has them.
std::vector<SweptColumn> swept_columns(const ArmReport& arm);
/// Those of a pair: what planning is for.
std::vector<SweptColumn> swept_columns(const Comparison& pair);

/// Columns that only the CSV of a study with grids has: the swept scenario, and every swept key. Blank where a scenario
/// has none.
class SweepColumns {
public:
    explicit SweepColumns(const Report& report);
    /// Each with a comma before it.
    std::string heads() const;
    std::string cells(const std::string& scenario) const;

private:
    std::map<std::string, SweepPoint> places_;
    std::vector<std::string> keys_;
};

/// The grids as tables, for people.
std::string sweep_text(const Report& report);

}  // namespace credence
