// The text report's tables by point of a sweep.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/sweep.hpp"

namespace credence {

std::string sweep_text(const Report& report) {
    const SweptReport swept(report);
    std::string text;
    for (const Grid& grid : swept.grids()) {
        std::vector<std::string> keys;
        for (const GridAxis& axis : grid.axes)
            keys.push_back(axis.key + " (" + std::to_string(axis.values.size()) + " values)");
        text += wrapped("sweep of " + grid.of + " over " + joined(keys) + ": mean ± 95 %") + "\n";
        for (const std::string& name : swept.arm_names(grid))
            text += "  " + name + "\n" + table_text(arm_table(swept, grid, name), 4);
        for (const std::string& name : swept.pair_names(grid))
            text += "  " + name + ", trial by trial\n" + table_text(pair_table(swept, grid, name), 4);
        text += "\n";
    }
    return text.empty() ? text
                        : text + "Of each point by itself, --format html, json and csv have all that was found.\n";
}

}  // namespace credence
