#include "report/format.hpp"
#include "report/html/charts/curves.hpp"

#include "report/html/charts/chart.hpp"

#include "report/html/page.hpp"

#include <algorithm>
#include <cmath>

namespace credence::page {

namespace {

constexpr double width = 360, height = 200, left = 52, right = width - 12, top = 24, bottom = height - 36;
constexpr std::size_t most_panels = 12;

/// A curve's value at one point.
struct Dot {
    std::size_t place;  ///< of the point's value along the axis
    Summary summary;
};

/// One panel on the scales of all.
class CurvePanel {
public:
    CurvePanel(const SweptCurves& all, const Scale& x, const Scale& y)
        : all_(all), axis_(all.grid.axes[all.axis]), x_(x), y_(y) {}

    Html html(const std::string& id, const std::string& title, const std::vector<std::vector<Dot>>& dots) {
        if (all_.margin > 0)
            svg_.box({left, y_(*all_.reference - all_.margin)}, {right, y_(*all_.reference + all_.margin)}, "margin",
                     "within the margin");
        draw_axes(title.empty() ? "" : all_.label);  // without a title the caption has the label
        if (all_.reference) svg_.line({left, y_(*all_.reference)}, {right, y_(*all_.reference)}, "ideal");
        for (std::size_t i = 0; i < dots.size(); ++i) draw_curve(i, dots[i]);
        const std::string where = title.empty() ? "" : " at " + title;
        return chart(title.empty() ? all_.label : title,
                     svg_.html(id, all_.grid.of + ": " + all_.label + " over " + axis_.key + where, described_));
    }

private:
    bool has_numbers() const { return !axis_.numbers.empty(); }
    double across(std::size_t place) const {
        return x_(has_numbers() ? axis_.numbers[place] : static_cast<double>(place));
    }

    void draw_axes(const std::string& label) {
        Axes{x_, y_, axis_.key, label, has_numbers() ? 6 : 0, 5}.draw(svg_);
        if (has_numbers()) return;
        constexpr std::size_t longest = 12;
        for (std::size_t i = 0; i < axis_.values.size(); ++i)
            svg_.text({across(i), bottom + 15}, Anchor::middle, shortened(axis_.values[i], longest));
    }

    /// A line through the means with its band; marks and whiskers at single points, and where values are missing.
    void draw_curve(std::size_t number, const std::vector<Dot>& dots) {
        const std::string series = series_class(number);
        std::vector<ChartPoint> middle, upper, lower;
        for (const Dot& dot : dots) {
            const double x = across(dot.place);
            middle.push_back({x, y_(dot.summary.mean)});
            upper.push_back({x, y_(dot.summary.ci95.high)});
            lower.push_back({x, y_(dot.summary.ci95.low)});
        }
        const bool curved = has_numbers() && dots.size() > 1;
        if (curved) {
            svg_.area(upper, lower, "spread " + series);
            svg_.path(middle, "line " + series);
        }
        for (std::size_t i = 0; i < dots.size(); ++i) {
            const std::string says = sentence(all_.names[number], dots[i]);
            if (!curved) svg_.line(lower[i], upper[i], "whisker " + series, says);
            svg_.mark(middle[i], number, says);
            described_ += says + ". ";
        }
    }

    std::string sentence(const std::string& name, const Dot& dot) const {
        return name + ", " + axis_.key + "=" + axis_.values[dot.place] + ": " + short_number(dot.summary.mean) +
               ", 95 % " + short_number(dot.summary.ci95.low) + " to " + short_number(dot.summary.ci95.high);
    }

    const SweptCurves& all_;
    const GridAxis& axis_;
    Scale x_, y_;
    Svg svg_{width, height};
    std::string described_;
};

Scale x_scale(const GridAxis& axis) {
    constexpr double logarithmic = 1;
    Range range;
    for (const double number : axis.numbers) range.include(number);
    if (axis.numbers.empty()) {
        range.include(-0.5);
        range.include(static_cast<double>(axis.values.size()) - 0.5);
    }
    return range.scale(left, right, evenly_by_ratio(axis.numbers) ? logarithmic : INFINITY);
}

/// Ranges over all panels, so that these can be compared.
Range y_range(const SweptCurves& all, const std::vector<std::vector<std::vector<Dot>>>& panels) {
    Range range;
    if (all.reference)
        for (const double side : {-1.6, 1.6}) range.include(*all.reference + side * all.margin);
    for (const auto& panel : panels)
        for (const auto& curve : panel)
            for (const Dot& dot : curve)
                for (const double value : {dot.summary.mean, dot.summary.ci95.low, dot.summary.ci95.high})
                    if (value > 0 || std::isinf(all.logarithmic_from)) range.include(value);
    return range;
}

}  // namespace

Html swept_panels(const SweptCurves& all, const std::string& id) {
    std::vector<GridCurve> along = curves_along(all.grid, all.axis);
    if (along.size() > most_panels) along.resize(most_panels);
    std::vector<std::vector<std::vector<Dot>>> panels;  // by panel and name
    for (const GridCurve& curve : along) {
        panels.emplace_back(all.names.size());
        for (std::size_t i = 0; i < all.names.size(); ++i)
            for (const GridPoint* point : curve.points)
                if (const std::optional<Summary> summary = all.at(*point, all.names[i]))
                    panels.back()[i].push_back({point->place[all.axis], *summary});
    }
    const Range range = y_range(all, panels);
    if (!range.known) return {};
    const Scale x = x_scale(all.grid.axes[all.axis]), y = range.scale(bottom, top, all.logarithmic_from);
    Html html;
    for (std::size_t i = 0; i < along.size(); ++i)
        html += CurvePanel(all, x, y).html(id + std::to_string(i), along[i].title, panels[i]);
    return html;
}

}  // namespace credence::page
