// The tables by point of a sweep, for text and page alike.

#include <credence/text.hpp>

#include "report/sweep.hpp"
#include "report/words.hpp"

#include <algorithm>

namespace credence {

namespace {

/// The values of a point's keys; the first one leads to the point's section.
std::vector<Cell> keys_of(const SweptReport& swept, const Grid& grid, const GridPoint& point) {
    std::vector<Cell> cells;
    const std::string& scenario = swept.scenario(point);
    for (std::size_t a = 0; a < grid.axes.size(); ++a) {
        const std::string& value = grid.axes[a].values[point.place[a]];
        const bool leads = a == 0 && swept.points_have_sections();
        cells.push_back(Cell::Piece{value, to_number(value), leads ? "scenario:" + scenario : ""});
    }
    return cells;
}

/// The keys, and the quantities after them.
std::vector<std::string> heads_of(const Grid& grid, const std::vector<SweptColumn>& columns) {
    std::vector<std::string> heads;
    for (const GridAxis& axis : grid.axes) heads.push_back(axis.key);
    for (const SweptColumn& column : columns) {
        if (column.name == "nees_ratio") heads.push_back("NEES/n");
        else if (column.name == "nis_ratio") heads.push_back("NIS/m");
        else if (column.name == "log_score") heads.push_back("log score");
        else heads.push_back(column.name + (column.unit == "1" ? "" : " [" + column.unit + "]"));
    }
    return heads;
}

/// The quantities of the first point that has the arm or pair.
template <class Find>
std::vector<SweptColumn> columns_of(const Grid& grid, const Find& find) {
    for (const GridPoint& point : grid.points)
        if (const auto* part = find(point)) return swept_columns(*part);
    return {};
}

}  // namespace

std::set<std::string> swept_scenarios(const Report& report) {
    std::set<std::string> swept;
    for (const Scenario& scenario : report.scenarios)
        if (SweptReport::swept(scenario)) swept.insert(scenario.name);
    return swept;
}

bool points_have_sections(const std::set<std::string>& swept) {
    constexpr std::size_t most = 12;
    return swept.size() <= most;
}

Table arm_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    const auto find = [&](const GridPoint& point) { return swept.arm(point, name); };
    std::vector<std::string> heads = heads_of(grid, columns_of(grid, find));
    heads.insert(heads.begin() + static_cast<std::ptrdiff_t>(grid.axes.size()), "verdict");
    heads.push_back("failed");
    Table table(grid.of + ", " + name + " by point: mean ± 95 %", heads, grid.axes.size());
    for (const GridPoint& point : grid.points) {
        const ArmReport* arm = find(point);
        if (arm == nullptr) continue;
        std::vector<Cell> cells = keys_of(swept, grid, point);
        cells.push_back(verdict_cell(*arm));
        for (const SweptColumn& one : swept_columns(*arm))
            cells.push_back(mean_cell(one.summary.mean, one.summary.ci95));
        cells.push_back(failed_cell(*arm));
        table.row(std::move(cells));
    }
    return table;
}

Table pair_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    const auto find = [&](const GridPoint& point) { return swept.pair(point, name); };
    Table table(grid.of + ", " + name + " by point, trial by trial: mean ± 95 %",
                heads_of(grid, columns_of(grid, find)), grid.axes.size());
    for (const GridPoint& point : grid.points) {
        const Comparison* pair = find(point);
        if (pair == nullptr) continue;
        const bool run = swept.has_run(point);
        std::vector<Cell> cells = keys_of(swept, grid, point);
        for (const SweptColumn& one : swept_columns(*pair))
            cells.push_back(run ? mean_cell(one.summary.mean, one.summary.ci95) : Cell("not run yet"));
        table.row(std::move(cells));
    }
    return table;
}

}  // namespace credence
