// The text report's tables by point of a sweep.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

#include <algorithm>

namespace credence {

namespace {

using Cells = std::vector<std::string>;

/// A table's content for one point, after the values of its keys.
struct PointRow {
    const GridPoint* point;
    Cells cells;
};

const std::string& key_value(const Grid& grid, const GridPoint& point, std::size_t axis) {
    return grid.axes[axis].values[point.place[axis]];
}

Cells joined_cells(Cells cells, const Cells& more) {
    cells.insert(cells.end(), more.begin(), more.end());
    return cells;
}

/// Writes the values of the keys in columns before the others.
TextTable with_key_columns(const Grid& grid, const Cells& heads, const std::vector<PointRow>& rows,
                           const std::string& alignment) {
    TextTable table(std::string(grid.axes.size(), 'r') + alignment);
    Cells keys;
    for (const GridAxis& axis : grid.axes) keys.push_back(axis.key);
    table.row(joined_cells(keys, heads));
    for (const PointRow& row : rows) {
        for (std::size_t a = 0; a < keys.size(); ++a) keys[a] = key_value(grid, *row.point, a);
        table.row(joined_cells(keys, row.cells));
    }
    return table;
}

/// Writes the values of the keys in a line before each row, where they do not fit into columns.
TextTable with_key_lines(const Grid& grid, const Cells& heads, const std::vector<PointRow>& rows,
                         const std::string& alignment) {
    TextTable table("l" + alignment);
    table.row(joined_cells({"  "}, heads));
    for (const PointRow& row : rows) {
        std::vector<std::string> keys;
        for (std::size_t a = 0; a < grid.axes.size(); ++a)
            keys.push_back(grid.axes[a].key + " = " + key_value(grid, *row.point, a));
        table.line("    " + wrapped_list("", keys, 4));
        table.row(joined_cells({"  "}, row.cells));
    }
    return table;
}

std::string table_text(const Grid& grid, const Cells& heads, const std::vector<PointRow>& rows,
                       const std::string& alignment) {
    if (rows.empty()) return "";
    const TextTable table = with_key_columns(grid, heads, rows, alignment);
    return table.fits() ? table.text() : with_key_lines(grid, heads, rows, alignment).text();
}

std::string figure_head(const SweptColumn& column) {
    if (column.name == "nees_ratio") return "NEES/n";
    if (column.name == "nis_ratio") return "NIS/m";
    return column.name + (column.unit == "1" ? "" : " [" + column.unit + "]");
}

Cells figure_cells(const std::vector<SweptColumn>& columns) {
    Cells cells;
    for (const SweptColumn& column : columns)
        cells.push_back(with_interval(column.summary.mean, column.summary.ci95));
    return cells;
}

Cells heads_of(const std::vector<SweptColumn>& columns) {
    Cells heads;
    for (const SweptColumn& column : columns) heads.push_back(figure_head(column));
    return heads;
}

std::string arm_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    Cells heads;
    std::vector<PointRow> rows;
    for (const GridPoint& point : grid.points) {
        const ArmReport* arm = swept.arm(point, name);
        if (arm == nullptr) continue;
        const std::vector<SweptColumn> columns = swept_columns(*arm);
        if (heads.empty()) heads = joined_cells(joined_cells({"verdict"}, heads_of(columns)), {"failed"});
        const Cells verdict{verdict_word(*arm)}, failed{arm->not_run() ? "-" : std::to_string(arm->failed_trials())};
        rows.push_back({&point, joined_cells(joined_cells(verdict, figure_cells(columns)), failed)});
    }
    return "  " + name + "\n" + table_text(grid, heads, rows, "lr");
}

std::string pair_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    Cells heads;
    std::vector<PointRow> rows;
    for (const GridPoint& point : grid.points) {
        const Comparison* pair = swept.pair(point, name);
        if (pair == nullptr) continue;
        const std::vector<SweptColumn> columns = swept_columns(*pair);
        if (heads.empty()) heads = heads_of(columns);
        Cells cells = figure_cells(columns);
        if (!has_run(swept.report(), swept.scenario(point)) && !cells.empty()) {
            cells.assign(cells.size(), "");
            cells.front() = "not run yet";
        }
        rows.push_back({&point, std::move(cells)});
    }
    return "  " + name + ", trial by trial\n" + table_text(grid, heads, rows, "r");
}

}  // namespace

std::string sweep_text(const Report& report) {
    const SweptReport swept(report);
    std::string text;
    for (const Grid& grid : swept.grids()) {
        std::vector<std::string> keys;
        for (const GridAxis& axis : grid.axes)
            keys.push_back(axis.key + " (" + std::to_string(axis.values.size()) + " values)");
        text += wrapped("sweep of " + grid.of + " over " + joined(keys) + ": mean ± 95 %") + "\n";
        for (const std::string& name : swept.arm_names(grid)) text += arm_table(swept, grid, name);
        for (const std::string& name : swept.pair_names(grid)) text += pair_table(swept, grid, name);
        text += "\n";
    }
    return text.empty() ? text
                        : text + "Of each point by itself, --format html, json and csv have all that was found.\n";
}

}  // namespace credence
