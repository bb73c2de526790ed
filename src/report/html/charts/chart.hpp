#pragma once
// Charts: scales with ticks at round numbers, and marks as inline SVG. Colours, widths and fonts are classes, so that
// the page's style sheet sets them for light, dark and print. All lengths are in units of the drawing's viewBox, y
// downwards.

#include "report/html/html.hpp"

#include <string>
#include <vector>

namespace credence {

/// normal: by the quantile z of the standard normal with P(|Z| <= z) = value, for shares from 0 to 1.
enum class ScaleKind { linear, logarithmic, normal };

/// Maps [low, high] onto [from, to]; values beyond an end are drawn at that end.
struct Scale {
    ScaleKind kind = ScaleKind::linear;
    double low = 0, high = 1, from = 0, to = 1;

    double operator()(double value) const;
};

/// A scale over these ends, which are moved where there would be none: a logarithmic one begins above 0, none ends
/// beyond what doubles can subtract, and its ends differ.
Scale scale_between(ScaleKind kind, double low, double high, double from, double to);

/// Round numbers within [low, high], about `about` of them and few more: multiples of 1, 2 or 5 times a power of ten;
/// on a logarithmic scale of more than a decade 1, 2 and 5 times powers of ten, or only those.
std::vector<double> ticks(const Scale& scale, int about);

/// Texts of ticks, all with the same decimals.
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

/// The smallest and the largest of what was included; NaN and infinity are left out.
struct Range {
    double low = 0, high = 0;
    bool known = false;

    void include(double value);
    /// A scale a little wider than the range; logarithmic if all is positive and high/low is above `logarithmic_from`.
    Scale scale(double from, double to, double logarithmic_from) const;
};

/// Which of `count` points in a row to draw: all, or about `most` at equal distances, the first and the last included.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

/// The steps of a series at which it has a value.
std::vector<std::size_t> observed(const std::vector<double>& values);

struct ChartPoint {
    double x = 0, y = 0;
};

enum class Anchor { start, middle, end };

/// The class of a series by its number, s0 ... s11: colour and dash of its lines. The first six have a colour each; the
/// second six have these once more, with other dashes and hollow marks.
std::string series_class(std::size_t series);

/// The first words of a text, and a sign that more follow, where it has more than `most` characters.
std::string shortened(const std::string& text, std::size_t most);

/// One drawing. `classes` are names from the style sheet; a `hover` text appears under the pointer.
class Svg {
public:
    Svg(double width, double height) : width_(width), height_(height) {}

    void line(ChartPoint from, ChartPoint to, const std::string& classes, const std::string& hover = {});
    /// Interrupted at points that are NaN.
    void path(const std::vector<ChartPoint>& points, const std::string& classes);
    /// Between two lines of as many points, left to right.
    void area(const std::vector<ChartPoint>& upper, const std::vector<ChartPoint>& lower, const std::string& classes);
    void box(ChartPoint corner, ChartPoint opposite, const std::string& classes, const std::string& hover = {});
    /// A mark of a series, by its number: one of six shapes, filled or hollow, of the series' class if of no other.
    void mark(ChartPoint at, std::size_t series, const std::string& hover, const std::string& classes = {});
    /// It is moved, and made narrower where it must be, so that it lies within the drawing.
    void text(ChartPoint at, Anchor anchor, const std::string& text, const std::string& classes = "label");
    /// With `title` and `description` as its text alternative; `id` is unique on the page.
    Html html(const std::string& id, const std::string& title, const std::string& description) const;
    /// As an icon beside words with the same meaning; of class `classes`.
    Html sign(const std::string& classes) const;

    double width() const { return width_; }
    double height() const { return height_; }

private:
    std::string view_box() const;
    void add(const std::string& shape, const std::string& attributes, const std::string& hover);

    double width_, height_;
    std::string body_;
};

/// Both axes with ticks, grid and labels. The x axis lies at y.from, the y axis at x.from.
struct Axes {
    Scale x, y;
    std::string x_label, y_label;
    int x_ticks = 6, y_ticks = 5;  ///< about as many; 0: none

    void draw(Svg& svg) const;
};

}  // namespace credence
