#include "report/sweep.hpp"

#include <credence/text.hpp>

#include "report/words.hpp"

#include <algorithm>

namespace credence {

namespace {

std::vector<std::string> keys_of(const SweepPoint& point) {
    std::vector<std::string> keys;
    for (const SweepCoordinate& one : point.at) keys.push_back(one.key);
    return keys;
}

// An arm and a pair differ in these.
std::string name_of(const ArmReport& arm) { return arm.arm; }
std::string name_of(const Comparison& pair) { return pair.name(); }
const char* kind_of(const ArmReport&) { return ""; }
const char* kind_of(const Comparison&) { return ", trial by trial"; }
bool is_shown(const ColumnReport& column) { return column.places.sweep; }
bool is_shown(const ComparedColumn& column) { return column.places.sweep_pairs; }
const Summary& summary_of(const ColumnReport& column) { return column.summary; }
const Summary& summary_of(const ComparedColumn& column) { return column.paired.difference; }

/// The columns that are shown: first those that have no meaning for pairs, as NEES and NIS.
template <class Column>
std::vector<const Column*> shown(const std::vector<Column>& columns) {
    std::vector<const Column*> found;
    for (const Column& column : columns)
        if (is_shown(column)) found.push_back(&column);
    std::stable_partition(found.begin(), found.end(), [](const Column* column) { return !column->places.sweep_pairs; });
    return found;
}

/// The keys, and the quantities after them.
template <class Part>
Table new_table(const Grid& grid, const Part& part) {
    std::vector<std::string> heads = grid.keys;
    constexpr bool is_arm = std::is_same_v<Part, ArmReport>;
    if (is_arm) heads.push_back("verdict");
    for (const auto* column : shown(part.columns)) {
        if (column->name == "nees_ratio") heads.push_back("NEES/n");
        else if (column->name == "nis_ratio") heads.push_back("NIS/m");
        else if (column->name == "log_score") heads.push_back("log score");
        else heads.push_back(column->name + (column->unit == "1" ? "" : " [" + column->unit + "]"));
    }
    if (is_arm) heads.push_back("failed");
    return {grid.of + ", " + name_of(part) + " by point" + kind_of(part) + ": mean ± 95 %", heads, grid.keys.size()};
}

/// The values of the keys, the first of which leads to the point's section, and the quantities after them.
template <class Part>
std::vector<Cell> row_of(const Scenario& point, const Part& part, bool has_section, bool has_run) {
    std::vector<Cell> cells;
    for (const SweepCoordinate& one : point.sweep.at)
        cells.push_back(Cell::Piece{one.value, to_number(one.value),
                                    has_section && cells.empty() ? "scenario:" + point.name : ""});
    constexpr bool is_arm = std::is_same_v<Part, ArmReport>;
    if constexpr (is_arm) cells.push_back(verdict_cell(part));
    for (const auto* column : shown(part.columns))
        cells.push_back(is_arm || has_run ? mean_cell(summary_of(*column).mean, summary_of(*column).ci95)
                                          : Cell("not run yet"));
    if constexpr (is_arm) cells.push_back(failed_cell(part));
    return cells;
}

}  // namespace

std::set<std::string> swept_scenarios(const Report& report) {
    std::set<std::string> swept;
    for (const Scenario& scenario : report.scenarios)
        if (is_swept(scenario)) swept.insert(scenario.name);
    return swept;
}

bool points_have_sections(const std::set<std::string>& swept) {
    constexpr std::size_t most = 12;
    return swept.size() <= most;
}

std::vector<Grid> grids_of(const Report& report) {
    std::vector<Grid> grids;
    for (const Scenario& scenario : report.scenarios) {
        if (!is_swept(scenario)) continue;
        const std::vector<std::string> keys = keys_of(scenario.sweep);
        auto grid = std::ranges::find_if(
            grids, [&](const Grid& one) { return one.of == scenario.sweep.of && one.keys == keys; });
        if (grid == grids.end()) grid = grids.insert(grid, {scenario.sweep.of, keys, {}});
        grid->points.emplace(scenario.name, &scenario);
    }
    return grids;
}

std::vector<SweptTable> tables_of(const Report& report, const Grid& grid) {
    const bool sections = points_have_sections(swept_scenarios(report));
    std::set<std::string> run;
    for (const ArmReport& arm : report.arms)
        if (!arm.not_run()) run.insert(arm.scenario);
    std::vector<SweptTable> tables;
    const auto add = [&](const auto& part) {
        const auto point = grid.points.find(part.scenario);
        if (point == grid.points.end()) return;
        const std::string head = name_of(part) + kind_of(part);
        auto table = std::ranges::find(tables, head, &SweptTable::head);
        if (table == tables.end()) table = tables.insert(table, {head, new_table(grid, part)});
        table->table.row(row_of(*point->second, part, sections, run.contains(part.scenario)));
    };
    for (const ArmReport& arm : report.arms) add(arm);
    for (const Comparison& pair : report.pairs) add(pair);
    return tables;
}

}  // namespace credence
