#pragma once
// A scenario of the world `explore` made ready: the tables that its equations read, computed once.

#include "slam/trial/problem.hpp"
#include "worlds/explore/walls.hpp"

namespace credence {

/// The grid of cells, row by row from its lower left corner.
struct CellGrid {
    Point corner;
    double cell = 1;
    int columns = 0, rows = 0;
    /// [cells] a bit for each neighbour to the east, north, west and south whose centre the robot can reach straight
    /// from the cell's own.
    const unsigned char* ways = nullptr;

    [[gnu::always_inline]] int count() const { return columns * rows; }
    [[gnu::always_inline]] Point centre(int i) const {
        return {corner.x + (i % columns + 0.5) * cell, corner.y + (i / columns + 0.5) * cell};
    }
    [[gnu::always_inline]] int neighbour(int i, int direction) const {
        const int steps[] = {1, columns, -1, -columns};
        return i + steps[direction];
    }
};

/// What a trial in this world reads beside what one in the deformable world does.
struct ExploreView : ProblemView {
    const WallLine* walls = nullptr;
    int wall_count = 0;
    double radius = 0;
    bool sees_all_round = true;
    double cosine_half_view = -1;
    LandmarkMap map = LandmarkMap::none;
    double prior = 0;
    MotionNoise motion_noise = MotionNoise::motion;
    CellGrid grid;
    double coverage = 0;       ///< what a cell is worth
    int chart_series = -1;     ///< the NEES of the whole state in the invariant chart; -1: none
    int own_series = 0;        ///< the first of the series that only this world has
};

/// The variance of a component that is absent: negligible in a trace, and its square still a number.
inline constexpr double absent_variance = 0x1p-200;

/// The series that only this world has, from ExploreView::own_series on; and its columns before the status.
enum ExploreSeries { series_dimension, series_unsettled, series_discovered, series_coverage, series_collisions,
                     explore_series_count };
enum ExploreColumn { column_discovered = column_status, column_coverage, column_collisions, explore_column_count =
                     column_collisions + 3 };

/// Those of any SLAM trial, and those of this world. Landmarks that may be absent are judged together alone.
std::vector<Column> explore_columns(const ExploreSettings& settings);
std::vector<Series> explore_series(const ExploreSettings& settings);
std::vector<ComponentGroup> explore_groups(const ExploreSettings& settings);

/// Owns the tables of resolved settings.
class ExploreProblem {
public:
    explicit ExploreProblem(const ExploreSettings& resolved_settings);
    ExploreProblem(const ExploreProblem&) = delete;
    ExploreProblem& operator=(const ExploreProblem&) = delete;

    const ExploreView& view() const { return view_; }
    const ExploreSettings& settings() const { return settings_; }

private:
    void fill_grid();
    void fill_growth(const std::vector<ComponentGroup>& groups);

    ExploreSettings settings_;
    Problem base_;
    std::vector<WallLine> walls_;
    std::vector<unsigned char> ways_;
    std::vector<double> coverage_bounds_, bounds_by_dimension_;
    ExploreView view_;
};

/// The wall with what follows from its ends.
WallLine line_of(const WallSegment& wall);
/// The distance of a point from a wall.
double distance(const WallLine& wall, const Point& place);
/// Columns and rows of the grid: as many whole cells as cover the box.
CellGrid grid_of(const ExploreSettings& settings);

}  // namespace credence
