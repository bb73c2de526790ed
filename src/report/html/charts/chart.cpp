// Marks and axes as SVG.

#include "report/html/charts/chart.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "report/format.hpp"

namespace credence {

namespace {

/// A coordinate to a hundredth, without zeros at its end; the same in every locale.
std::string coordinate(double value) {
    char buffer[64];
    const double rounded = std::nearbyint(value * 100) / 100;
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, rounded == 0 ? 0.0 : rounded).ptr;
    return std::string(buffer, end);
}

std::string pair(ChartPoint point) { return coordinate(point.x) + " " + coordinate(point.y); }

std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }

std::string attribute(const std::string& name, double value) { return attribute(name, coordinate(value)); }

bool known(ChartPoint point) { return !std::isnan(point.x) && !std::isnan(point.y); }

constexpr std::size_t colours = 6, distinct = 2 * colours;

bool hollow(std::size_t series) { return series % distinct >= colours; }

/// The outline of a mark about the origin; a colour's second series has another shape than its first.
const char* outline(std::size_t series) {
    static const char* const outlines[colours] = {"M-3.2 0a3.2 3.2 0 1 0 6.4 0a3.2 3.2 0 1 0-6.4 0Z",
                                                  "M0-4.4L4.4 0 0 4.4-4.4 0Z",
                                                  "M-3-3H3V3H-3Z",
                                                  "M0-4L4 3H-4Z",
                                                  "M0 4L4-3H-4Z",
                                                  "M-1.4-4H1.4V-1.4H4V1.4H1.4V4H-1.4V1.4H-4V-1.4H-1.4Z"};
    return outlines[(series + (hollow(series) ? colours / 2 : 0)) % colours];
}

}  // namespace

std::string shortened(const std::string& text, std::size_t most) {
    if (characters(text) <= static_cast<int>(most)) return text;
    std::string start;
    for (std::size_t i = 0, count = 0; i < text.size(); ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80 && ++count == most) break;
        start += text[i];
    }
    const std::size_t blank = start.find_last_of(' ');
    return start.substr(0, blank == std::string::npos || blank < start.size() / 2 ? start.size() : blank) + "…";
}

std::string series_class(std::size_t series) { return "s" + std::to_string(series % distinct); }

void Svg::add(const std::string& shape, const std::string& attributes, const std::string& hover) {
    body_ += "<" + shape + attributes;
    body_ += hover.empty() ? "/>" : "><title>" + escaped(hover).text() + "</title></" + shape + ">";
    body_ += "\n";
}

void Svg::line(ChartPoint from, ChartPoint to, const std::string& classes, const std::string& hover) {
    if (!known(from) || !known(to)) return;
    add("path", attribute("class", classes) + attribute("d", "M" + pair(from) + "L" + pair(to)), hover);
}

void Svg::path(const std::vector<ChartPoint>& points, const std::string& classes) {
    std::string d;
    bool drawing = false;
    for (const ChartPoint& point : points) {
        if (known(point)) d += (drawing ? "L" : "M") + pair(point);
        drawing = known(point);
    }
    if (!d.empty()) add("path", attribute("class", classes) + attribute("d", d), {});
}

void Svg::area(const std::vector<ChartPoint>& upper, const std::vector<ChartPoint>& lower, const std::string& classes) {
    std::string d;
    const auto add_point = [&](const std::vector<ChartPoint>& line, std::size_t i) {
        const bool level = i > 0 && i + 1 < line.size() && line[i - 1].y == line[i].y && line[i].y == line[i + 1].y;
        if (known(line[i]) && !level) d += (d.empty() ? "M" : "L") + pair(line[i]);
    };
    for (std::size_t i = 0; i < upper.size(); ++i) add_point(upper, i);
    for (std::size_t i = lower.size(); i-- > 0;) add_point(lower, i);
    if (!d.empty()) add("path", attribute("class", classes) + attribute("d", d + "Z"), {});
}

void Svg::box(ChartPoint corner, ChartPoint opposite, const std::string& classes, const std::string& hover) {
    if (!known(corner) || !known(opposite)) return;
    add("rect",
        attribute("class", classes) + attribute("x", std::min(corner.x, opposite.x)) +
            attribute("y", std::min(corner.y, opposite.y)) + attribute("width", std::abs(corner.x - opposite.x)) +
            attribute("height", std::abs(corner.y - opposite.y)),
        hover);
}

void Svg::mark(ChartPoint at, std::size_t series, const std::string& hover, const std::string& classes) {
    if (!known(at)) return;
    add("path",
        attribute("class",
                  "mark " + (classes.empty() ? series_class(series) + (hollow(series) ? " hollow" : "") : classes)) +
            attribute("transform", "translate(" + pair(at) + ")") + attribute("d", outline(series)),
        hover);
}

void Svg::text(ChartPoint at, Anchor anchor, const std::string& text, const std::string& classes) {
    const char* const anchors[] = {"start", "middle", "end"};
    constexpr double of_character = 6.2;  // about, in a wide font
    const double room = width_ - 4, asked = of_character * characters(text), length = std::min(room, asked),
                 before = length * static_cast<int>(anchor) / 2,
                 x = std::clamp(at.x, 2 + before, 2 + before + room - length);
    body_ += "<text" + attribute("class", classes) + attribute("x", x) + attribute("y", at.y) +
             attribute("text-anchor", anchors[static_cast<int>(anchor)]) +
             (asked > room ? attribute("textLength", room) + attribute("lengthAdjust", "spacingAndGlyphs") : "") + ">" +
             escaped(text).text() + "</text>\n";
}

Html Svg::html(const std::string& id, const std::string& title, const std::string& description) const {
    const std::string safe = escaped(id).text();
    return Html::trusted(
        "<svg" + view_box() + " role=\"img\"" + attribute("aria-labelledby", safe + "-t " + safe + "-d") + ">\n<title" +
        attribute("id", safe + "-t") + ">" + escaped(title).text() + "</title>\n<desc" + attribute("id", safe + "-d") +
        ">" + escaped(description).text() + "</desc>\n" + body_ + "</svg>\n");
}

Html Svg::sign(const std::string& classes) const {
    return Html::trusted("<svg" + attribute("class", classes) + view_box() + " aria-hidden=\"true\">" + body_ +
                         "</svg>");
}

std::string Svg::view_box() const {
    return attribute("viewBox", "0 0 " + coordinate(width_) + " " + coordinate(height_));
}

void Axes::draw(Svg& svg) const {
    const std::vector<double> across = ticks(x, x_ticks), up = ticks(y, y_ticks);
    const std::vector<std::string> across_texts = tick_texts(across), up_texts = tick_texts(up);
    for (std::size_t i = 0; i < up.size(); ++i) {
        svg.line({x.from, y(up[i])}, {x.to, y(up[i])}, "grid");
        svg.text({x.from - 5, y(up[i]) + 3.5}, Anchor::end, up_texts[i]);
    }
    for (std::size_t i = 0; i < across.size(); ++i) {
        svg.line({x(across[i]), y.from}, {x(across[i]), y.from + 4}, "axis");
        svg.text({x(across[i]), y.from + 15}, Anchor::middle, across_texts[i]);
    }
    svg.line({x.from, y.from}, {x.to, y.from}, "axis");
    if (!x_label.empty()) svg.text({(x.from + x.to) / 2, y.from + 29}, Anchor::middle, x_label, "label name");
    if (!y_label.empty()) svg.text({x.from - 5, y.to - 8}, Anchor::start, y_label, "label name");
}

}  // namespace credence
