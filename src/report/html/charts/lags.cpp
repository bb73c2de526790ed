// The page's charts by lag: how long errors and innovations depend on each other.

#include "base/thinned.hpp"
#include "report/format.hpp"
#include "report/html/charts/chart.hpp"
#include "report/html/page.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

constexpr double width = 360, height = 176, left = 46, right = width - 12, top = 24, bottom = height - 36;

void draw_band(Svg& svg, const Axes& axes, const std::vector<Whiteness>& lags, double Whiteness::*bound,
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

Html autocorrelation_chart(const Part& part) {
    const SegmentEvidence& segments = part.arms.front()->evidence.segments;
    const std::vector<double>& values = segments.correlation;
    if (values.empty()) return {};
    Range range;
    range.include(0);
    for (const double value : values) range.include(value);
    const Axes axes{scale_between(ScaleKind::linear, 0, static_cast<double>(values.size() - 1), left, right),
                    range.scale(bottom, top, INFINITY), "lag", "correlation"};
    const auto at = [&](std::size_t lag) { return ChartPoint{axes.x(static_cast<double>(lag)), axes.y(values[lag])}; };
    std::vector<ChartPoint> line;
    for (const std::size_t lag : thinned_line(values, 300)) line.push_back(at(lag));
    const std::string says = segments.window == 0 ? "does not decorrelate within half of the run"
                                                  : number(segments.autocorrelation_time, 1) + " steps, cut at lag " +
                                                        std::to_string(segments.window);
    Svg svg(width, height);
    axes.draw(svg);
    svg.line({left, axes.y(0)}, {right, axes.y(0)}, "ideal");
    svg.path(line, "line " + series_class(0));
    const std::size_t end = segments.window > 0 ? segments.window : values.size() - 1;
    svg.line({at(end).x, bottom}, {at(end).x, top}, "published", says);
    svg.mark(at(end), 0, says);
    const std::string caption = segments.slowest + ": " + says;
    return chart(part, caption, svg, "autocorrelation", "autocorrelation by lag", caption + ".");
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
        draw_band(svg, axes, lags, &Whiteness::simultaneous_bound, "band joint");
        draw_band(svg, axes, lags, &Whiteness::bound, "band");
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
        html += chart(part, part.arms[i]->arm, svg, "whiteness" + std::to_string(i),
                      "correlation of innovations by lag", described);
    }
    return html;
}

}  // namespace credence::page
