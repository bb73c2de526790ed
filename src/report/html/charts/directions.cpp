// The page's charts of directions: how large the errors are in every combination of the state, against what P says.

#include <credence/text.hpp>

#include "report/format.hpp"
#include "report/html/charts/chart.hpp"
#include "report/html/page.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace credence::page {

namespace {

bool has_directions(const ArmReport& arm) { return !arm.consistency.directions.spectrum.empty(); }

/// Ratios of all directions of the whole state, an arm a row, with the interval that contains them.
Html spectrum_chart(const Part& part) {
    constexpr double width = 360, left = 96, right = width - 12, top = 34, row = 26;
    const double margin = part.report.limits.direction, bottom = top + row * static_cast<double>(part.arms.size());
    Range range;
    for (const double end : {1 - 1.6 * margin, 1 + 1.6 * margin}) range.include(end);
    for (const ArmReport* arm : part.arms) {
        const DirectionsFound& found = arm->consistency.directions;
        for (const double ratio : found.spectrum) range.include(ratio);
        if (has_directions(*arm) && found.range.low > 0)
            range.include(found.range.low), range.include(found.range.high);
    }
    const Scale x = range.scale(left, right, 4);
    Svg svg(width, bottom + 36);
    svg.box({x(1 - margin), top}, {x(1 + margin), bottom}, "margin", "within the margin of directions");
    svg.line({x(1), top}, {x(1), bottom}, "ideal");
    svg.text({left, 12}, Anchor::start, "◀ smaller than P says");
    svg.text({right, 12}, Anchor::end, "larger ▶");
    Axes{x, {ScaleKind::linear, 0, 1, bottom, top}, "squared error over what P says, by direction", "", 5, 0}.draw(svg);
    std::string described;
    for (std::size_t i = 0; i < part.arms.size(); ++i) {
        const DirectionsFound& found = part.arms[i]->consistency.directions;
        const double y = top + row * (static_cast<double>(i) + 0.5);
        svg.text({left - 8, y + 4}, Anchor::end, shortened(part.arms[i]->arm, 14), "label row");
        if (found.spectrum.empty()) continue;
        const std::string says = part.arms[i]->arm + ": " + short_number(found.spectrum.front()) + " to " +
                                 short_number(found.spectrum.back()) + ", all within " + short_number(found.range.low) +
                                 " to " + short_number(found.range.high) + " with 95 %";
        svg.line({x(found.range.low), y}, {x(found.range.high), y}, "whisker " + series_class(i), says);
        for (const double ratio : found.spectrum)
            svg.mark({x(ratio), y}, i, part.arms[i]->arm + ": " + short_number(ratio));
        described += says + ". ";
    }
    return chart(part, "Directions of the whole state", svg, "directions", "squared error over P's, by direction",
                 described);
}

/// An ellipse with these half-axes about a centre, as a closed path.
std::vector<ChartPoint> ellipse(ChartPoint centre, double along_x, double along_y) {
    constexpr int points = 72;
    std::vector<ChartPoint> path;
    for (int i = 0; i <= points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        path.push_back({centre.x + along_x * std::cos(angle), centre.y - along_y * std::sin(angle)});
    }
    return path;
}

/// The plane of the largest and the smallest direction, in which P is a circle: the ellipse of the errors beside it.
Html ellipse_chart(const Part& part, std::size_t i) {
    const ArmReport& arm = *part.arms[i];
    const DirectionsFound& found = arm.consistency.directions;
    if (found.largest.empty() || found.smallest.empty()) return {};
    const DirectionOfGroup &largest = found.largest.front(), &smallest = found.smallest.front();
    constexpr double width = 360, height = 250, room = 88;
    constexpr std::size_t most = 72;
    const ChartPoint centre{width / 2, 112};
    const double wide = std::sqrt(largest.ratio), high = std::sqrt(smallest.ratio),
                 unit = room / std::max({1.0, wide, high});
    Svg svg(width, height);
    svg.path(ellipse(centre, unit, unit), "line ideal");
    svg.path(ellipse(centre, unit * wide, unit * high), "line " + series_class(i));
    for (const double side : {-1.0, 1.0}) {
        svg.mark({centre.x + side * unit * wide, centre.y}, i, largest.name + ": " + short_number(wide));
        svg.mark({centre.x, centre.y + side * unit * high}, i, smallest.name + ": " + short_number(high));
    }
    svg.text({width / 2, height - 26}, Anchor::middle, "→ " + shortened(largest.name, most));
    svg.text({width / 2, height - 8}, Anchor::middle, "↑ " + shortened(smallest.name, most));
    const std::string says = arm.arm + ": the errors are " + short_number(wide) + " times as large as P says along " +
                             largest.name + ", and " + short_number(high) + " times along " + smallest.name;
    return chart(part, arm.arm + ": errors (line) against P (circle)", svg, "ellipse-" + std::to_string(i),
                 "worst plane of " + arm.arm, says);
}

/// `0.70711 x, -0.70711 y`
std::string shares_text(const std::vector<Loading>& loadings) {
    std::vector<std::string> shares;
    for (const Loading& one : loadings) shares.push_back(short_number(one.weight) + " " + one.component);
    return joined(shares);
}

}  // namespace

Html direction_charts(const Part& part) {
    constexpr std::size_t most = 6;
    if (std::ranges::none_of(part.arms, [](const ArmReport* arm) { return has_directions(*arm); })) return {};
    Html html = spectrum_chart(part);
    for (std::size_t i = 0; i < std::min(most, part.arms.size()); ++i) html += ellipse_chart(part, i);
    return html;
}

Html direction_tables(const Part& part) {
    Table table(part.scenario.name + ": directions, the squared error of combinations of the state over what P says",
                {"arm, group", "direction", "ratio", "interval, corrected", "shares of the components, in sigmas"});
    Table spectrum(part.scenario.name + ": all directions of the whole state",
                       {"arm", "ratios", "every direction within, 95 %", "from these trials"});
    for (const ArmReport* arm : part.arms) {
        const DirectionsFound& found = arm->consistency.directions;
        for (const auto* all : {&found.largest, &found.smallest})
            for (const DirectionOfGroup& one : *all)
                table.row(arm->arm + ", " + one.group, {one.name, short_cell(one.ratio), range_cell(one.interval),
                                                        shares_text(one.loadings)});
        if (found.spectrum.empty()) continue;
        Cell ratios;
        for (const double ratio : found.spectrum)
            ratios = ratios + (ratios.pieces().empty() ? "" : ", ") + short_cell(ratio);
        spectrum.row(arm->arm, {ratios, range_cell(found.range), count_cell(found.trials)});
    }
    return folded("Directions, with their intervals", html_of(spectrum) + html_of(table));
}

Html worst_trials_table(const Part& part) {
    Table table(part.scenario.name + ": the detailed trials with the largest NEES",
                {"arm, trial", "NEES/dim", "largest at step"});
    Html shares;
    for (const ArmReport* arm : part.arms) {
        const WorstTrials& worst = arm->evidence.worst;
        for (const WorstTrial& one : worst.trials)
            table.row(arm->arm + ", " + std::to_string(one.trial), {short_cell(one.nees_ratio), count_cell(one.step)});
        if (!worst.trials.empty())
            shares +=
                element("p", escaped(arm->arm + ": they have a share of " + short_number(worst.share) + " of NEES.")) +
                "\n"_html;
    }
    return folded("Trials with the largest NEES", html_of(table) + shares);
}

}  // namespace credence::page
