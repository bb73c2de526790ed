// The page's charts by step: a panel for each component group and each group of rows.

#include "base/thinned.hpp"
#include "report/format.hpp"
#include "report/html/charts/chart.hpp"

#include "report/html/page.hpp"
#include "report/words.hpp"

#include <credence/text.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// Where steps lie: at their times in seconds, from the first one on, or without these at their numbers.
struct Across {
    std::vector<double> at;  ///< by step
    std::string label = "step";
    double half = 0.5;       ///< of the way to the next
    Scale scale;

    Across(std::vector<double> times, std::size_t steps) : at(std::move(times)) {
        const bool timed = !at.empty();
        at.resize(steps);
        if (!timed) std::iota(at.begin(), at.end(), 1);
        const std::vector<std::size_t> known = observed(at);
        const double first = at[known.front()];
        if (timed) label = "time [s]" + (first == 0 ? "" : " from " + to_text(first) + " s on");
        for (double& time : at) time -= timed ? first : 0;
        const double start = at[known.front()], end = at[known.back()];
        if (known.size() > 1) half = (end - start) / static_cast<double>(2 * (steps - 1));
        scale = scale_between(ScaleKind::linear, start - half, end + half, left, right);
    }
    double operator()(std::size_t k, double halves = 0) const { return scale(at[k] + halves * half); }
    std::string step(std::size_t k) const {
        return "step " + std::to_string(k + 1) + (label == "step" ? "" : ", " + short_number(at[k]) + " s");
    }
};

/// Ranges over all panels, so that these can be compared.
Scale upward(const std::vector<Panel>& panels, double logarithmic_from) {
    Range range;
    range.include(1);
    for (const Panel& panel : panels)
        for (const Series& series : panel.series)
            for (std::size_t k = 0; k < series.ratio->ratio.size(); ++k) {
                range.include(series.ratio->ratio[k]);
                const Interval& band = series.ratio->simultaneous_band[k];
                if (band.low > 0) range.include(band.low);
                range.include(band.high);
            }
    return range.scale(bottom, top, logarithmic_from);
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

void draw_band(Svg& svg, const Axes& axes, const Across& x, const std::vector<Interval>& band,
               const std::string& classes) {
    std::vector<double> heights;
    for (const Interval& interval : band) heights.push_back(interval.high);
    std::vector<ChartPoint> upper, lower;
    for (const std::size_t k : line_steps(heights))
        for (const double side : {-1.0, 1.0}) {
            upper.push_back({x(k, side), axes.y(band[k].high)});
            lower.push_back({x(k, side), axes.y(band[k].low)});
        }
    svg.area(upper, lower, classes);
}

void draw_bands(Svg& svg, const Axes& axes, const Across& x, const Panel& panel) {
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        if (i > 0 && panel.series[i].ratio->degrees == panel.series.front().ratio->degrees) continue;  // the same bands
        draw_band(svg, axes, x, panel.series[i].ratio->simultaneous_band, "band joint");
        draw_band(svg, axes, x, panel.series[i].ratio->band, "band");
    }
}

std::string hover(const Series& series, const Across& x, std::size_t k) {
    const BandedRatio& ratio = *series.ratio;
    return series.arm + ", " + x.step(k) + ": " + short_number(ratio.ratio[k]) + " (joint band " +
           short_number(ratio.simultaneous_band[k].low) + " to " + short_number(ratio.simultaneous_band[k].high) + ")";
}

/// No line goes across the long gaps of a run.
void draw_gaps(Svg& svg, const Across& x, const RunCurves& run) {
    for (const auto& [before, behind] : run.gaps)
        svg.box({x(before, 1), top}, {x(behind, -1), bottom - 1}, "gap",
                "no steps between " + x.step(before) + " and " + x.step(behind));
}

/// A line and its marks: of the series at `place` among more than two, marks at different steps, so that none hides
/// another, and at the last; of a long one alone, of the steps outside the joint band.
void draw_series(Svg& svg, const Axes& axes, const Across& x, const Series& series, std::size_t place,
                 std::size_t among) {
    const std::vector<double>& values = series.ratio->ratio;
    const auto at = [&](std::size_t k) { return ChartPoint{x(k), axes.y(values[k])}; };
    std::vector<ChartPoint> line;
    for (const std::size_t k : line_steps(values)) line.push_back(at(k));
    svg.path(line, "line " + series_class(series.number));
    std::vector<std::size_t> steps = observed(values);
    if (among == 1 && steps.size() > 2 * most_line_points)
        std::erase_if(steps, [&, last = steps.back()](std::size_t k) {
            const Interval& band = series.ratio->simultaneous_band[k];
            return k != last && values[k] >= band.low && values[k] <= band.high;
        });
    const std::vector<std::size_t> places = thinned(steps.size(), most_marks);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (among <= 2 || i % among == place || i + 1 == places.size())
            svg.mark(at(steps[places[i]]), series.number, hover(series, x, steps[places[i]]));
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
    const std::vector<RunCurves>& runs = part.arms.front()->curves;
    const RunCurves run = runs.size() == 1 ? runs.front() : RunCurves();
    const Scale y = upward(panels, runs.empty() ? 5 : INFINITY);  // chi-square of few reaches 0
    Html html;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::size_t steps = panels[i].series.front().ratio->ratio.size();
        const Across x(run.times, steps);
        const Axes axes{x.scale, y, x.label, measure, static_cast<int>(std::min<std::size_t>(8, steps)), 5};
        Svg svg(width, height);
        draw_bands(svg, axes, x, panels[i]);
        axes.draw(svg);
        svg.line({left, y(1)}, {right, y(1)}, "ideal");
        const std::vector<Series>& series = panels[i].series;
        for (std::size_t s = 0; s < series.size(); ++s) draw_series(svg, axes, x, series[s], s, series.size());
        draw_gaps(svg, x, run);
        html += chart(part, panels[i].name, svg, what + std::to_string(i),
                      measure + " of " + panels[i].name + " by step", description(panels[i], measure));
    }
    return html;
}

/// Adds a series to the panel of that name.
void add_to(std::vector<Panel>& panels, const std::string& name, const Series& series) {
    auto panel = std::ranges::find(panels, name, &Panel::name);
    if (panel == panels.end()) panel = panels.insert(panel, {name, {}});
    panel->series.push_back(series);
}

/// Beside far smaller errors the band goes on outside.
Scale upward(const ErrorCurve& curve) {
    Range range;
    for (const ErrorCurve::Point& point : curve.points) range.include(point.error);
    const double most = 4 * std::max(-range.low, range.high);
    for (const ErrorCurve::Point& point : curve.points)
        for (const double side : {-1, 1}) range.include(side * std::min(2 * point.sigma, most));
    return range.scale(bottom, top, INFINITY);
}

Html error_chart(const Part& part, const RunCurves& run, const ErrorCurve& curve, const std::string& what,
                 const std::string& of) {
    const std::string unit = with_powers(curve.unit);
    const Across x(run.times, static_cast<std::size_t>(part.scenario.poses - 1));
    const Axes axes{x.scale, upward(curve), x.label, unit.empty() ? "error" : "error [" + unit + "]"};
    std::vector<ChartPoint> line, upper, lower;
    const ErrorCurve::Point* worst = &curve.points.front();
    for (const ErrorCurve::Point& point : curve.points) {
        line.push_back({x(point.step), axes.y(point.error)});
        upper.push_back({line.back().x, axes.y(2 * point.sigma)});
        lower.push_back({line.back().x, axes.y(-2 * point.sigma)});
        if (std::abs(point.error) / point.sigma > std::abs(worst->error) / worst->sigma) worst = &point;
    }
    const std::string says = "largest at " + x.step(worst->step) + ": " + short_number(worst->error) + " " + unit +
                             ", P's sigma " + short_number(worst->sigma);
    Svg svg(width, height);
    svg.area(upper, lower, "band");
    axes.draw(svg);
    svg.line({left, axes.y(0)}, {right, axes.y(0)}, "ideal");
    svg.path(line, "line " + series_class(0));
    draw_gaps(svg, x, run);
    svg.mark({x(worst->step), axes.y(worst->error)}, 0, says);
    const double share = static_cast<double>(curve.outside) / static_cast<double>(curve.steps);
    return chart(part, of + ": " + percent(share) + " beyond two sigma", svg, what, "error of " + of + " by step",
                 of_steps(static_cast<int>(curve.outside), static_cast<int>(curve.steps)) +
                     " steps are beyond two sigma; " + says + ".");
}

}  // namespace

Html error_charts(const Part& part) {
    const std::vector<RunCurves>& runs = part.arms.front()->curves;
    Html html;
    int number = 0;
    for (std::size_t i = 0; i < runs.size(); ++i)
        for (const ErrorCurve& curve : runs[i].errors)
            if (curve.steps > 0)
                html += error_chart(part, runs[i], curve, "error" + std::to_string(++number),
                                    (runs.size() > 1 ? "run " + std::to_string(i) + ", " : "") + curve.component);
    return html;
}

Html nees_panels(const Part& part) {
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < part.arms.size(); ++i)
        if (part.arms[i]->evidence.trials > 0)
            for (const GroupEvidence* group : shown_groups(part.arms[i]->evidence))
                add_to(panels, group->name, {part.arms[i]->arm, i, &group->anees});
    return panels_html(part, panels, "NEES/dim", "nees");
}

Html nis_panels(const Part& part) {
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < part.arms.size(); ++i)
        for (const NisEvidence& nis : part.arms[i]->evidence.nis)
            add_to(panels, "rows: " + nis.part, {part.arms[i]->arm, i, &nis.nis});
    return panels_html(part, panels, "NIS/m", "nis");
}

}  // namespace credence::page
