// The page's section on sweeps: curves along a swept key, and a table by point.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/page.hpp"
#include "report/html/charts/curves.hpp"
#include "report/sweep.hpp"
#include "report/words.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

/// A quantity of an arm or a pair; nothing where it has no values.
template <class Part>
std::optional<Summary> summary_of(const Part* part, const std::string& column) {
    if (part != nullptr)
        for (const SweptColumn& one : swept_columns(*part))
            if (one.name == column && one.summary.count > 0) return one.summary;
    return std::nullopt;
}

/// A sweep on the page.
class GridPart {
public:
    GridPart(const Report& report, const SweptReport& swept, const Grid& grid, std::size_t number)
        : report_(report), swept_(swept), grid_(grid), id_("sweep:" + std::to_string(number)),
          arms_(swept.arm_names(grid)), pairs_(swept.pair_names(grid)) {
        std::vector<std::string> keys;
        for (const GridAxis& axis : grid.axes) keys.push_back(axis.key);
        keys_ = joined(keys);
    }

    Html html() const {
        Html tables;
        for (const std::string& name : arms_) tables += html_of(arm_table(swept_, grid_, name));
        for (const std::string& name : pairs_) tables += html_of(pair_table(swept_, grid_, name));
        return "<section aria-labelledby=\""_html + escaped(id_) + "\">\n"_html +
               element("h2", escaped("Sweep of " + grid_.of + " over " + keys_),
                       "id=\""_html + escaped(id_) + "\""_html) +
               "\n<h3>Curves</h3>\n"_html + curves() + "<h3>By point</h3>\n"_html + tables + "</section>\n"_html;
    }

private:
    /// The shown quantities that some point has of these arms or pairs.
    template <class Find>
    std::vector<SweptColumn> columns_of(const std::vector<std::string>& names, const Find& find) const {
        for (const GridPoint& point : grid_.points)
            for (const std::string& name : names)
                if (const auto* part = find(point, name)) return swept_columns(*part);
        return {};
    }

    Html curves() const {
        const auto arm = [&](const GridPoint& point, const std::string& name) { return swept_.arm(point, name); };
        const auto pair = [&](const GridPoint& point, const std::string& name) { return swept_.pair(point, name); };
        Html of_arms, of_pairs;
        std::size_t number = 0;
        for (const SweptColumn& one : columns_of(arms_, arm)) {
            const bool is_nees = one.name == "nees_ratio", is_ratio = is_nees || one.name == "nis_ratio";
            constexpr double spread = 20;  // beyond it the small values could not be distinguished from 0
            const SweptCurves drawn{grid_,
                                    curve_axis(grid_),
                                    arms_,
                                    column_words(one.name, one.unit),
                                    is_ratio ? std::optional<double>(1) : std::nullopt,
                                    is_nees ? report_.limits.margin : 0,
                                    spread,
                                    [&](const GridPoint& point, const std::string& name) {
                                        return summary_of(swept_.arm(point, name), one.name);
                                    }};
            of_arms += swept_panels(drawn, id_ + "." + std::to_string(number++) + "-");
        }
        for (const SweptColumn& one : columns_of(pairs_, pair)) {
            const SweptCurves drawn{grid_, curve_axis(grid_), pairs_,
                                    "difference of " + column_words(one.name, one.unit), 0, 0, INFINITY,
                                    [&](const GridPoint& point, const std::string& name) {
                                        return summary_of(swept_.pair(point, name), one.name);
                                    }};
            of_pairs += swept_panels(drawn, id_ + "." + std::to_string(number++) + "-");
        }
        return legend(arms_) +
               chart_group("Arms", "Means with their 95 % intervals; shaded: within the margin.", of_arms) +
               (of_pairs.empty() ? Html() : legend(pairs_)) +
               chart_group("Pairs, trial by trial", "Below 0 the first arm has less.", of_pairs);
    }

    const Report& report_;
    const SweptReport& swept_;
    const Grid& grid_;
    std::string id_, keys_;
    std::vector<std::string> arms_, pairs_;
};

}  // namespace

Html sweeps(const Report& report) {
    const SweptReport swept(report);
    Html html;
    for (std::size_t i = 0; i < swept.grids().size(); ++i)
        html += GridPart(report, swept, swept.grids()[i], i).html();
    return html;
}

}  // namespace credence::page
