#include "report/sweep.hpp"

#include <credence/text.hpp>

#include <algorithm>

namespace credence {

namespace {

/// The names that a part of the report has at the points of a grid, each once, in the report's order.
template <class Part, class Name>
std::vector<std::string> names_of(const std::set<std::string>& scenarios, const std::vector<Part>& parts,
                                  const Name& name_of) {
    std::vector<std::string> names;
    for (const Part& part : parts)
        if (scenarios.count(part.scenario) > 0 &&
            std::find(names.begin(), names.end(), name_of(part)) == names.end())
            names.push_back(name_of(part));
    return names;
}

template <class Map>
auto found_in(const Map& map, const typename Map::key_type& key) -> typename Map::mapped_type {
    const auto found = map.find(key);
    return found == map.end() ? nullptr : found->second;
}

}  // namespace

SweptReport::SweptReport(const Report& report) : report_(report) {
    std::vector<SweepPoint> places;
    for (const Scenario& scenario : report.scenarios) places.push_back(scenario.sweep);
    grids_ = grids_of(places);
    for (const ArmReport& arm : report.arms) {
        arms_[{arm.scenario, arm.arm}] = &arm;
        if (!arm.not_run()) run_.insert(arm.scenario);
    }
    points_have_sections_ = credence::points_have_sections(swept_scenarios(report));
    for (const Comparison& pair : report.pairs) pairs_[{pair.scenario, pair.name()}] = &pair;
}

const ArmReport* SweptReport::arm(const GridPoint& point, const std::string& name) const {
    return found_in(arms_, {scenario(point), name});
}

const Comparison* SweptReport::pair(const GridPoint& point, const std::string& name) const {
    return found_in(pairs_, {scenario(point), name});
}

std::vector<std::string> SweptReport::arm_names(const Grid& grid) const {
    return names_of(names_of_points(grid), report_.arms, [](const ArmReport& arm) { return arm.arm; });
}

std::vector<std::string> SweptReport::pair_names(const Grid& grid) const {
    return names_of(names_of_points(grid), report_.pairs, [](const Comparison& pair) { return pair.name(); });
}

std::set<std::string> SweptReport::names_of_points(const Grid& grid) const {
    std::set<std::string> names;
    for (const GridPoint& point : grid.points) names.insert(scenario(point));
    return names;
}

namespace {

/// These names, and behind them the columns that neither every world nor one of credence's has: a user's own.
template <class Columns>
std::vector<std::string> and_own(std::vector<std::string> names, const Columns& columns) {
    static const std::set<std::string> usual{"trace_P",    "unseen",       "pose_error", "squared_error", "nees_ratio",
                                             "nis_ratio", "mean_trace_P", "log_score",  "path_length"};
    for (const auto& column : columns)
        if (!usual.contains(column.name)) names.push_back(column.name);
    return names;
}

}  // namespace

std::vector<SweptColumn> swept_columns(const ArmReport& arm) {
    std::vector<SweptColumn> columns;
    for (const std::string& name : and_own({"nees_ratio", "nis_ratio", "trace_P", "log_score"}, arm.columns))
        for (const ColumnReport& column : arm.columns)
            if (column.name == name) columns.push_back({column.name, column.unit, column.summary});
    return columns;
}

std::vector<SweptColumn> swept_columns(const Comparison& pair) {
    std::vector<SweptColumn> columns;
    for (const std::string& name :
         and_own({"trace_P", "unseen", "pose_error", "squared_error", "log_score"}, pair.columns))
        for (const ComparedColumn& column : pair.columns)
            if (column.name == name) columns.push_back({column.name, column.unit, column.paired.difference});
    return columns;
}

SweepColumns::SweepColumns(const Report& report) {
    for (const Scenario& scenario : report.scenarios) {
        if (SweptReport::swept(scenario)) places_[scenario.name] = scenario.sweep;
        for (const SweepCoordinate& one : scenario.sweep.at)
            if (std::find(keys_.begin(), keys_.end(), one.key) == keys_.end()) keys_.push_back(one.key);
    }
}

std::vector<Cell> SweepColumns::heads() const {
    std::vector<Cell> heads;
    if (!keys_.empty()) heads.push_back("sweep_of");
    heads.insert(heads.end(), keys_.begin(), keys_.end());
    return heads;
}

std::vector<Cell> SweepColumns::cells(const std::string& scenario) const {
    if (keys_.empty()) return {};
    const auto found = places_.find(scenario);
    const SweepPoint place = found == places_.end() ? SweepPoint{} : found->second;
    std::vector<Cell> cells{place.of};
    for (const std::string& key : keys_) {
        const auto one = std::ranges::find(place.at, key, &SweepCoordinate::key);
        cells.push_back(one == place.at.end() ? Cell() : Cell(one->value));
    }
    return cells;
}

}  // namespace credence
