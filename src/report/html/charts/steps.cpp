// The page's charts by step and by lag: a panel for each component group, each group of rows, each arm.

#include "report/format.hpp"
#include "report/html/charts/chart.hpp"

#include "report/html/page.hpp"
#include "report/words.hpp"

#include <cmath>

namespace credence::page {

namespace {

constexpr double width = 360, height = 176, left = 46, right = width - 12, top = 24, bottom = height - 36;
constexpr std::size_t most_marks = 60, most_line_points = 300;

/// One arm's values by step.
struct Series {
    std::string arm;
    std::size_t number;
    const BandedRatio* ratio;
};

/// A panel: what it is of, and the arms that have it.
struct Panel {
    std::string name;
    std::vector<Series> series;
};

Scale across(std::size_t steps) { return {ScaleKind::linear, 0.5, static_cast<double>(steps) + 0.5, left, right}; }

/// Ranges over all panels, so that these can be compared.
Scale upward(const std::vector<Panel>& panels) {
    Range range;
    range.include(1);
    for (const Panel& panel : panels)
        for (const Series& series : panel.series)
            for (std::size_t k = 0; k < series.ratio->ratio.size(); ++k) {
                range.include(series.ratio->ratio[k]);
                if (series.ratio->simultaneous_band[k].low > 0) range.include(series.ratio->simultaneous_band[k].low);
                range.include(series.ratio->simultaneous_band[k].high);
            }
    return range.scale(bottom, top, 5);
}

/// The steps through which a line is drawn, of those with a value: a sensor may speak at every tenth step.
std::vector<std::size_t> line_steps(const std::vector<double>& values) {
    const std::vector<std::size_t> steps = observed(values);
    std::vector<double> known;
    for (const std::size_t k : steps) known.push_back(values[k]);
    std::vector<std::size_t> chosen;
    for (const std::size_t i : thinned_line(known, most_line_points)) chosen.push_back(steps[i]);
    return chosen;
}

void draw_band(Svg& svg, const Axes& axes, const std::vector<Interval>& band, const std::string& classes) {
    std::vector<double> heights;
    for (const Interval& interval : band) heights.push_back(interval.high);
    std::vector<ChartPoint> upper, lower;
    for (const std::size_t k : line_steps(heights)) {
        const double step = static_cast<double>(k) + 1;
        for (const double x : {step - 0.5, step + 0.5}) {
            upper.push_back({axes.x(x), axes.y(band[k].high)});
            lower.push_back({axes.x(x), axes.y(band[k].low)});
        }
    }
    svg.area(upper, lower, classes);
}

bool same_bands(const BandedRatio& a, const BandedRatio& b) { return a.degrees == b.degrees; }

void draw_bands(Svg& svg, const Axes& axes, const Panel& panel) {
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        if (i > 0 && same_bands(*panel.series[i].ratio, *panel.series.front().ratio)) continue;
        draw_band(svg, axes, panel.series[i].ratio->simultaneous_band, "band joint");
        draw_band(svg, axes, panel.series[i].ratio->band, "band");
    }
}

std::string hover(const Series& series, std::size_t k) {
    const BandedRatio& ratio = *series.ratio;
    return series.arm + ", step " + std::to_string(k + 1) + ": " + short_number(ratio.ratio[k]) + " (joint band " +
           short_number(ratio.simultaneous_band[k].low) + " to " + short_number(ratio.simultaneous_band[k].high) + ")";
}

/// A line and its marks: of the series at `place` among more than two, marks at different steps, so that none hides
/// another, and at the last.
void draw_series(Svg& svg, const Axes& axes, const Series& series, std::size_t place, std::size_t among) {
    const std::vector<double>& values = series.ratio->ratio;
    const auto at = [&](std::size_t k) { return ChartPoint{axes.x(static_cast<double>(k) + 1), axes.y(values[k])}; };
    std::vector<ChartPoint> line;
    for (const std::size_t k : line_steps(values)) line.push_back(at(k));
    svg.path(line, "line " + series_class(series.number));
    const std::vector<std::size_t> steps = observed(values), places = thinned(steps.size(), most_marks);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (among <= 2 || i % among == place || i + 1 == places.size())
            svg.mark(at(steps[places[i]]), series.number, hover(series, steps[places[i]]));
}

std::string description(const Panel& panel, const std::string& measure) {
    std::string text;
    for (const Series& series : panel.series) {
        Range range;
        for (const double value : series.ratio->ratio) range.include(value);
        if (range.known)
            text += series.arm + ": " + measure + " from " + short_number(range.low) + " to " +
                    short_number(range.high) + ", outside the joint band at " +
                    of_steps(series.ratio->outside_simultaneous, series.ratio->observed) + " steps. ";
    }
    return text;
}

Html panels_html(const Part& part, const std::vector<Panel>& panels, const std::string& measure,
                 const std::string& what) {
    const Scale y = upward(panels);
    Html html;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::size_t steps = panels[i].series.front().ratio->ratio.size();
        const Axes axes{across(steps), y, "step", measure, static_cast<int>(std::min<std::size_t>(8, steps)), 5};
        Svg svg(width, height);
        draw_bands(svg, axes, panels[i]);
        axes.draw(svg);
        svg.line({left, y(1)}, {right, y(1)}, "ideal");
        const std::vector<Series>& series = panels[i].series;
        for (std::size_t s = 0; s < series.size(); ++s) draw_series(svg, axes, series[s], s, series.size());
        html +=
            chart(panels[i].name, svg.html(part.id(what + std::to_string(i)),
                                           part.scenario.name + ": " + measure + " of " + panels[i].name + " by step",
                                           description(panels[i], measure)));
    }
    return html;
}

/// Collects panels by name: add(name, series).
class Panels {
public:
    void add(const std::string& name, const Series& series) {
        for (Panel& panel : panels_)
            if (panel.name == name) return panel.series.push_back(series);
        panels_.push_back({name, {series}});
    }
    const std::vector<Panel>& list() const { return panels_; }

private:
    std::vector<Panel> panels_;
};

void draw_whiteness_band(Svg& svg, const Axes& axes, const std::vector<Whiteness>& lags, double Whiteness::*bound,
                         const std::string& classes) {
    std::vector<ChartPoint> upper, lower;
    for (const Whiteness& lag : lags)
        for (const double x : {lag.lag - 0.5, lag.lag + 0.5}) {
            upper.push_back({axes.x(x), axes.y(lag.*bound)});
            lower.push_back({axes.x(x), axes.y(-(lag.*bound))});
        }
    svg.area(upper, lower, classes);
}

}  // namespace

Html nees_panels(const Part& part) {
    Panels panels;
    for (std::size_t i = 0; i < part.arms.size(); ++i)
        if (part.arms[i]->evidence.trials > 0)
            for (const GroupEvidence* group : shown_groups(part.arms[i]->evidence))
                panels.add(group->name, {part.arms[i]->arm, i, &group->anees});
    return panels_html(part, panels.list(), "NEES/dim", "nees");
}

Html nis_panels(const Part& part) {
    Panels panels;
    for (std::size_t i = 0; i < part.arms.size(); ++i)
        for (const NisEvidence& nis : part.arms[i]->evidence.nis)
            panels.add("rows: " + nis.part, {part.arms[i]->arm, i, &nis.nis});
    return panels_html(part, panels.list(), "NIS/m", "nis");
}

Html whiteness_chart(const Part& part) {
    Range range;
    for (const ArmReport* arm : part.arms)
        for (const Whiteness& lag : arm->evidence.whiteness)
            for (const double value : {lag.scaled, lag.simultaneous_bound, -lag.simultaneous_bound})
                range.include(value);
    if (!range.known) return {};
    Html html;
    for (std::size_t i = 0; i < part.arms.size(); ++i) {
        const std::vector<Whiteness>& lags = part.arms[i]->evidence.whiteness;
        if (lags.empty()) continue;
        const Scale x{ScaleKind::linear, 0.5, lags.back().lag + 0.5, left, right};
        const Axes axes{x, range.scale(bottom, top, INFINITY), "lag", "correlation", std::min(10, lags.back().lag), 5};
        Svg svg(width, height);
        draw_whiteness_band(svg, axes, lags, &Whiteness::simultaneous_bound, "band joint");
        draw_whiteness_band(svg, axes, lags, &Whiteness::bound, "band");
        axes.draw(svg);
        svg.line({left, axes.y(0)}, {right, axes.y(0)}, "ideal");
        std::string described = part.arms[i]->arm + ": ";
        for (const Whiteness& lag : lags) {
            if (!lag.known()) continue;
            const std::string says = "lag " + std::to_string(lag.lag) + ": " + short_number(lag.scaled) +
                                     " (white within ± " + short_number(lag.bound) + ")";
            svg.line({x(lag.lag), axes.y(0)}, {x(lag.lag), axes.y(lag.scaled)}, "line " + series_class(i));
            svg.mark({x(lag.lag), axes.y(lag.scaled)}, i, part.arms[i]->arm + ", " + says);
            described += says + ". ";
        }
        html +=
            chart(part.arms[i]->arm, svg.html(part.id("whiteness" + std::to_string(i)),
                                              part.scenario.name + ": correlation of innovations by lag", described));
    }
    return html;
}

}  // namespace credence::page
