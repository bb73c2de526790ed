// The text report's tables by grid point.

#include <credence/text.hpp>

#include "report_format.hpp"
#include "report_sweep.hpp"
#include "report_words.hpp"

#include <algorithm>

namespace credence {

namespace {

constexpr int figure_width = 24;

/// Columns of the swept keys, wide enough for their values.
class KeyColumns {
public:
    explicit KeyColumns(const Grid& grid) : grid_(grid) {
        for (const GridAxis& axis : grid.axes) {
            std::size_t width = axis.key.size();
            for (const std::string& value : axis.values) width = std::max(width, std::min(value.size(), longest));
            widths_.push_back(static_cast<int>(width) + 2);
        }
    }
    std::string heads() const {
        std::string text = "  ";
        for (std::size_t a = 0; a < widths_.size(); ++a) text += padded(grid_.axes[a].key, widths_[a]);
        return text;
    }
    std::string values(const GridPoint& point) const {
        std::string text = "  ";
        for (std::size_t a = 0; a < widths_.size(); ++a) {
            const std::string& value = grid_.axes[a].values[point.place[a]];
            text += padded(value.size() > longest ? value.substr(0, longest - 3) + "..." : value, widths_[a]);
        }
        return text;
    }

private:
    static constexpr std::size_t longest = 24;
    const Grid& grid_;
    std::vector<int> widths_;
};

std::string figure_head(const SweptFigure& figure) {
    if (figure.name == "nees_ratio") return "NEES/n";
    if (figure.name == "nis_ratio") return "NIS/m";
    return figure.name + (figure.unit == "1" ? "" : " [" + figure.unit + "]");
}

std::string figure_cells(const std::vector<SweptFigure>& figures) {
    std::string text;
    for (const SweptFigure& figure : figures)
        text += padded(with_interval(figure.summary.mean, figure.summary.ci95), figure_width);
    return text;
}

std::string heads_of(const std::vector<SweptFigure>& figures) {
    std::string text;
    for (const SweptFigure& figure : figures) text += padded(figure_head(figure), figure_width);
    return text;
}

std::string arm_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    const KeyColumns keys(grid);
    std::string heads, rows;
    for (const GridPoint& point : grid.points) {
        const ArmReport* arm = swept.arm(point, name);
        if (arm == nullptr) continue;
        const std::vector<SweptFigure> figures = swept_figures(*arm);
        if (heads.empty())
            heads = keys.heads() + "  " + padded("verdict", 12, false) + heads_of(figures) + padded("failed", 9) + "\n";
        rows += keys.values(point) + "  " + padded(verdict_name(arm->consistency.verdict), 12, false) +
                figure_cells(figures) + padded(std::to_string(arm->failed), 9) + "\n";
    }
    return "  " + name + "\n" + heads + rows;
}

std::string pair_table(const SweptReport& swept, const Grid& grid, const std::string& name) {
    const KeyColumns keys(grid);
    std::string heads, rows;
    for (const GridPoint& point : grid.points) {
        const Comparison* pair = swept.pair(point, name);
        if (pair == nullptr) continue;
        const std::vector<SweptFigure> figures = swept_figures(*pair);
        if (heads.empty()) heads = keys.heads() + heads_of(figures) + "\n";
        rows += keys.values(point) + figure_cells(figures) + "\n";
    }
    return "  " + name + ", trial by trial\n" + heads + rows;
}

}  // namespace

std::string sweep_text(const Report& report) {
    const SweptReport swept(report);
    std::string text;
    for (const Grid& grid : swept.grids()) {
        std::vector<std::string> keys;
        for (const GridAxis& axis : grid.axes)
            keys.push_back(axis.key + " (" + std::to_string(axis.values.size()) + " values)");
        text += "sweep of " + grid.of + " over " + joined(keys) + ": mean ± 95 %\n";
        for (const std::string& name : swept.arm_names(grid)) text += arm_table(swept, grid, name);
        for (const std::string& name : swept.pair_names(grid)) text += pair_table(swept, grid, name);
        text += "\n";
    }
    return text.empty() ? text
                        : text + "Of each point by itself, --format html, json and csv have all that was found.\n";
}

}  // namespace credence
