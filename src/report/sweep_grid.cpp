#include "report/sweep_grid.hpp"

#include <credence/statistics.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

bool same_axes(const Grid& grid, const SweepPoint& point) {
    return grid.of == point.of &&
           std::equal(grid.axes.begin(), grid.axes.end(), point.at.begin(), point.at.end(),
                      [](const GridAxis& axis, const SweepCoordinate& one) { return axis.key == one.key; });
}

/// The index of a value along an axis; a new value is added to the axis.
std::size_t place_on(GridAxis& axis, const std::string& value) {
    const auto found = std::find(axis.values.begin(), axis.values.end(), value);
    const auto place = static_cast<std::size_t>(found - axis.values.begin());
    if (found == axis.values.end()) axis.values.push_back(value);
    return place;
}

std::vector<double> numbers_of(const std::vector<std::string>& values) {
    std::vector<double> numbers;
    for (const std::string& value : values) {
        const std::optional<double> number = to_number(value);
        if (!number || !std::isfinite(*number)) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

/// Coefficient of variation of the differences of neighbours.
double unevenness(const std::vector<double>& sorted) {
    std::vector<double> differences;
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i) differences.push_back(sorted[i + 1] - sorted[i]);
    const Summary summary = summarise(differences);
    return summary.standard_deviation / summary.mean;
}

}  // namespace

std::vector<Grid> grids_of(const std::vector<SweepPoint>& places) {
    std::vector<Grid> grids;
    for (std::size_t s = 0; s < places.size(); ++s) {
        const SweepPoint& point = places[s];
        if (point.at.empty()) continue;
        auto grid = std::find_if(grids.begin(), grids.end(), [&](const Grid& one) { return same_axes(one, point); });
        if (grid == grids.end()) {
            grids.push_back({point.of, {}, {}});
            grid = grids.end() - 1;
            for (const SweepCoordinate& one : point.at) grid->axes.push_back({one.key, {}, {}});
        }
        grid->points.push_back({s, {}});
        for (std::size_t a = 0; a < point.at.size(); ++a)
            grid->points.back().place.push_back(place_on(grid->axes[a], point.at[a].value));
    }
    for (Grid& grid : grids)
        for (GridAxis& axis : grid.axes) axis.numbers = numbers_of(axis.values);
    return grids;
}

bool evenly_by_ratio(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    if (values.size() < 3 || values.front() <= 0) return false;
    std::vector<double> logarithms;
    for (const double value : values) logarithms.push_back(std::log(value));
    return unevenness(logarithms) < unevenness(values);
}

std::size_t curve_axis(const Grid& grid) {
    for (std::size_t a = 0; a < grid.axes.size(); ++a)
        if (!grid.axes[a].numbers.empty()) return a;
    return 0;
}

std::vector<GridCurve> curves_along(const Grid& grid, std::size_t axis) {
    std::vector<GridCurve> curves;
    for (const GridPoint& point : grid.points) {
        std::vector<SweepCoordinate> others;
        for (std::size_t a = 0; a < grid.axes.size(); ++a)
            if (a != axis) others.push_back({grid.axes[a].key, grid.axes[a].values[point.place[a]]});
        const std::string title = coordinates_text(others);
        auto curve =
            std::find_if(curves.begin(), curves.end(), [&](const GridCurve& one) { return one.title == title; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), {title, {}});
        curve->points.push_back(&point);
    }
    if (const std::vector<double>& numbers = grid.axes[axis].numbers; !numbers.empty())
        for (GridCurve& curve : curves)
            std::stable_sort(curve.points.begin(), curve.points.end(), [&](const GridPoint* a, const GridPoint* b) {
                return numbers[a->place[axis]] < numbers[b->place[axis]];
            });
    return curves;
}

}  // namespace credence
