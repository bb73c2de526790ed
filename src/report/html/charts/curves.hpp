#pragma once
// Curves with bands along a swept key.

#include "report/html/html.hpp"
#include <credence/statistics.hpp>

#include "report/sweep_grid.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace credence::page {

/// A quantity to be drawn over a sweep: one curve for each name, one panel for each combination of the other keys'
/// values.
struct SweptCurves {
    const Grid& grid;
    std::size_t axis;                 ///< that the curves run along
    std::vector<std::string> names;   ///< of the arms, or of the pairs
    std::string label;                ///< of the quantity
    std::optional<double> reference;  ///< drawn as a line
    double margin = 0;                ///< about the reference; 0: none
    /// The ratio of the largest to the smallest beyond which the scale is logarithmic.
    double logarithmic_from = 0;
    /// Mean and interval of a name at a point; nothing where there are none.
    std::function<std::optional<Summary>(const GridPoint&, const std::string&)> at;
};

/// The panels, on the same scales: only the first of them where there are very many. `id` is unique on the page.
Html swept_panels(const SweptCurves& curves, const std::string& id);

}  // namespace credence::page
