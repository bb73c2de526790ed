#include "worlds/explore/problem.hpp"

#include "base/nan.hpp"
#include <credence/detail/functions.hpp>
#include "scenario/state_series.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

constexpr int group_features = Layout<Process::heading, any_count>::group_features;

/// Whether a series is of a landmark by itself.
bool of_one_landmark(const Series& series) {
    return series.part.starts_with("feature_") && series.role != SeriesRole::standardised_error;
}

}  // namespace

std::vector<ComponentGroup> explore_groups(const ExploreSettings& settings) {
    std::vector<ComponentGroup> groups = state_groups(settings);
    if (settings.map == LandmarkMap::none) groups.resize(group_features + 1);
    return groups;
}

std::vector<Column> explore_columns(const ExploreSettings& settings) {
    std::vector<Column> columns = trial_columns(settings);
    const auto at = columns.begin() + column_status;
    columns.insert(at, {{"discovered", "landmarks that were seen", "1", ColumnType::integer, -1, {.watch = false}},
                        {"coverage", "share of the cells that were in view", "1", ColumnType::real, nan},
                        {"collisions", "motions that a wall ended", "1", ColumnType::integer, -1, {.watch = false}}});
    return columns;
}

std::vector<Series> explore_series(const ExploreSettings& settings) {
    std::vector<Series> all = step_series(settings);
    const auto count = [&](const char* name, const char* what, bool integer = true) {
        all.push_back({name, what, "1", SeriesRole::other, 0, integer, "", "", 0});
    };
    if (settings.map == LandmarkMap::none) {
        std::erase_if(all, of_one_landmark);
        for (Series& series : all) {
            if (series.role != SeriesRole::nees && series.role != SeriesRole::nees_in_chart) continue;
            if (series.part == "all") series.rows = "state_dimension";
            if (series.part == "features") series.rows = "state_dimension", series.more_rows = -pose_size(settings);
        }
    }
    count("state_dimension", "components that are in the state");
    count("unsettled_updates", "iterated updates whose last pass still moved the mean");
    count("discovered", "landmarks that were seen");
    count("coverage", "share of the cells that were in view", false);
    count("collisions", "motions that a wall ended");
    return all;
}

WallLine line_of(const WallSegment& wall) {
    const Point along{wall.to.x - wall.from.x, wall.to.y - wall.from.y};
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    return {wall.from, wall.to, {along.x / length, along.y / length}, length};
}

double distance(const WallLine& wall, const Point& place) {
    const Vector2<double> along = broadcast<double>(wall.direction),
                          start = broadcast<double>(place) - broadcast<double>(wall.from);
    const double reached = std::clamp(dot_product(along, start), 0.0, wall.length);
    return std::sqrt(squared_norm(add_scaled(start, -reached, along)));
}

CellGrid grid_of(const ExploreSettings& settings) {
    const Point &low = settings.box[0], &high = settings.box[1];
    const auto cells = [&](double side) {  // a side of a whole number of cells has them, whatever the rounding
        return static_cast<int>(std::ceil(std::min(side / settings.cell, 1.0 * largest_cell_count) - 1e-9));
    };
    return {low, settings.cell, cells(high.x - low.x), cells(high.y - low.y)};
}

ExploreProblem::ExploreProblem(const ExploreSettings& resolved_settings)
    : settings_(resolved_settings), base_(settings_) {
    static_cast<ProblemView&>(view_) = base_.view();
    // Features stand still here, so that as_features is the path of the waypoints.
    if (settings_.fixed_path != FixedPath::as_features) view_.control.waypoints = view_.control.fixed;
    for (const WallSegment& wall : settings_.walls) walls_.push_back(line_of(wall));
    view_.walls = walls_.data();
    view_.wall_count = static_cast<int>(walls_.size());
    view_.radius = settings_.radius;
    view_.sees_all_round = settings_.view >= 2 * std::numbers::pi;
    view_.cosine_half_view = cos(settings_.view / 2);
    view_.map = settings_.map;
    view_.prior = settings_.prior;
    view_.motion_noise = settings_.motion_noise;
    view_.coverage = settings_.coverage;
    const std::vector<ComponentGroup> groups = explore_groups(settings_);
    coverage_bounds_ = coverage_bounds(groups);
    view_.group_count = static_cast<int>(groups.size());
    view_.coverage_bounds = coverage_bounds_.data();
    const std::vector<Series> all = explore_series(settings_);
    view_.series_count = static_cast<int>(all.size());
    view_.own_series = view_.series_count - explore_series_count;
    if (view_.charts == Charts::euclidean_and_invariant) view_.chart_series = view_.own_series - 2;
    if (view_.map == LandmarkMap::none) fill_growth(groups);
    fill_grid();
}

/// Quantiles of chi-square by dimension, times the whole dimension over that of the part that is there.
void ExploreProblem::fill_growth(const std::vector<ComponentGroup>& groups) {
    const int pose = pose_size(settings_);
    for (const ComponentGroup& group : {groups.front(), groups[group_features]})
        for (int there = 0; there <= group.count; ++there) {
            const double ratio = there == 0 ? 0 : 1.0 * group.count / there;
            for (const double bound : coverage_bounds(std::vector<ComponentGroup>{{"", 0, std::max(there, 1)}}))
                bounds_by_dimension_.push_back(ratio * bound);
        }
    view_.growth = {view_.own_series + series_dimension, group_features, pose, absent_variance,
                    bounds_by_dimension_.data()};
}

void ExploreProblem::fill_grid() {
    view_.grid = grid_of(settings_);
    const CellGrid& grid = view_.grid;
    const auto clear = [&](const Point& from, const Point& to) {
        return std::ranges::all_of(walls_, [&](const WallLine& wall) {
            return distance(wall, from) >= settings_.radius && distance(wall, to) >= settings_.radius &&
                   free_share<double>(wall, settings_.radius, broadcast<double>(from),
                                      {to.x - from.x, to.y - from.y}) == 1;
        });
    };
    for (int i = 0; i < grid.count(); ++i) {
        const bool inside[] = {(i + 1) % grid.columns != 0, i + grid.columns < grid.count(), i % grid.columns != 0,
                               i >= grid.columns};
        int ways = 0;
        for (int direction = 0; direction < 4; ++direction)
            if (inside[direction] && clear(grid.centre(i), grid.centre(grid.neighbour(i, direction))))
                ways |= 1 << direction;
        ways_.push_back(static_cast<unsigned char>(ways));
    }
    view_.grid.ways = ways_.data();
}

}  // namespace credence
