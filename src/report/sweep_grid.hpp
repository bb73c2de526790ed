#pragma once
// The grids of a study: the scenarios that are points of one, and their places in it.

#include <credence/detail/sweep.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace credence {

/// A swept key and its values, in the order in which the study has them.
struct GridAxis {
    std::string key;
    std::vector<std::string> values;
    std::vector<double> numbers;  ///< the same as numbers; empty where one of them is not a number
};

/// A scenario of the study as a point of a grid.
struct GridPoint {
    std::size_t scenario;              ///< its place in the study
    std::vector<std::size_t> place;    ///< of its value along each axis
};

/// The points of one scenario under the same swept keys, in the study's order.
struct Grid {
    std::string of;
    std::vector<GridAxis> axes;
    std::vector<GridPoint> points;
};

/// The grids of a study, in the order of their first points. `places` has the place of each scenario in its grid.
std::vector<Grid> grids_of(const std::vector<SweepPoint>& places);

/// Whether values look evenly spaced on a logarithmic rather than on a linear axis: all are positive, there are at
/// least three, and their ratios vary less, by coefficient of variation, than their differences.
bool evenly_by_ratio(std::vector<double> values);

/// The axis along which curves are drawn: the first one with numbers, or the first.
std::size_t curve_axis(const Grid& grid);

/// The points of a grid, grouped by their values on all axes but one: a curve each, in the study's order.
struct GridCurve {
    std::string title;                     ///< `sensor.sigma=0.05`; empty where there is no other axis
    std::vector<const GridPoint*> points;  ///< increasing along the axis where it has numbers
};
std::vector<GridCurve> curves_along(const Grid& grid, std::size_t axis);

}  // namespace credence
