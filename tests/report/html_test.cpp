// Pieces of a page: escaped texts, numbers, scales with round ticks, points that are left out, histograms.

#include "catch.hpp"

#include "report/format.hpp"
#include "base/thinned.hpp"
#include "report/html/charts/chart.hpp"
#include <credence/detail/histogram.hpp>
#include "report/html/html.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace credence::test::html_test {

using Catch::Contains;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("html: any text from outside is escaped") {
    CHECK(escaped("<script>alert('1')</script> & \"co\"").text() ==
          "&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; &quot;co&quot;");
    CHECK(escaped("größer").text() == "größer");
    CHECK(escaped(std::string("a\x01z\0b", 5)).text() ==
          "a\xEF\xBF\xBDz\xEF\xBF\xBD"
          "b");
    CHECK(escaped("a\xC2\x9B\xE2\x80\xAE").text() == "a\xEF\xBF\xBD\xEF\xBF\xBD");  // CSI, right to left
    CHECK(escaped("\xFF<").text() == "\xEF\xBF\xBD&lt;");  // not UTF-8
    CHECK_THAT(html_of(Table("<b>", {"<i>"}).row({"<u>"})).text(),
               !Contains("<b>") && !Contains("<i>") && !Contains("<u>"));
    Svg svg(10, 10);
    svg.text({1, 1}, Anchor::start, "<b>");
    svg.mark({1, 1}, 0, "<b>");
    CHECK_THAT(svg.html("x", "<b>", "<b>").text(), !Contains("<b>"));
}

TEST_CASE("html: a number is shown rounded and carries its exact value") {
    CHECK(html_of(number_cell(0.1, 2)).text() == "<data value=\"0.1\">0.10</data>");
    CHECK(html_of(number_cell(none, 2)).text() == "-");
    CHECK_THAT(html_of(number_cell(1.0 / 3, 4)).text(), Contains("\"0.3333333333333333\">0.3333<"));
    CHECK(html_of(interval_cell({none, 1}, 2)).text() == "-");
    CHECK(short_number(0.123456) == "0.12346");
    CHECK(short_number(276634) == "276634");
    CHECK(short_number(3) == "3");
    CHECK(html_of(count_cell(12345678)).text() == "<data value=\"12345678\">12345678</data>");
    CHECK(short_number(2e-7) == "2e-07");
    CHECK(short_number(none) == "-");
    CHECK(with_powers("dm^2 + rad^2") == "dm² + rad²");
}

TEST_CASE("chart: ticks are round, within the axis, and about as many as asked for") {
    const Scale unit{ScaleKind::linear, 0, 1, 0, 100};
    CHECK(tick_texts(ticks(unit, 5)) == std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
    CHECK(tick_texts(ticks({ScaleKind::logarithmic, 0.05, 300, 0, 1}, 4)) ==
          std::vector<std::string>{"0.1", "1", "10", "100"});
    CHECK(ticks({ScaleKind::linear, 2, 2, 0, 1}, 5).empty());
    for (const double spread : {3e-7, 0.02, 0.7, 1.0, 19.0, 1e5})
        for (const double low : {-2.5 * spread, 0.0, 0.31 * spread, 40 * spread}) {
            const std::vector<double> found = ticks({ScaleKind::linear, low, low + spread, 0, 1}, 5);
            CHECK(found.size() >= 2);
            CHECK(found.size() <= 8);  // a step of 5 instead of 2 or of 2 instead of 1: up to 2.5 times fewer or more
            CHECK(found.front() >= low - 1e-9 * spread);
            CHECK(found.back() <= low + 1.000001 * spread);
        }
}

TEST_CASE("chart: a scale maps its ends, and keeps what is beyond at them") {
    const Scale up{ScaleKind::linear, 0, 10, 100, 20};
    CHECK(up(0) == 100);
    CHECK(up(10) == 20);
    CHECK(up(5) == Approx(60));
    CHECK(up(1e300) == 20);
    CHECK(Scale{ScaleKind::logarithmic, 0.01, 100, 0, 4}(1) == Approx(2));
    const Scale normal{ScaleKind::normal, 0, 0.999, 0, 1};
    CHECK(normal(0.95) / normal(0.5) == Approx(1.959964 / 0.6744898));  // z of 95 % over z of 50 %
    CHECK(normal(1) == 1);
    Range range;
    range.include(none);
    CHECK_FALSE(range.known);
    for (const double value : {0.5, 4.0}) range.include(value);
    CHECK(range.scale(0, 1, 5).kind == ScaleKind::logarithmic);
    CHECK(range.scale(0, 1, 9).kind == ScaleKind::linear);
    CHECK(range.scale(0, 1, 9).low < 0.5);
}

TEST_CASE("chart: of many points few are drawn, and a line keeps its extremes") {
    CHECK(thinned(5, 10) == std::vector<std::size_t>{0, 1, 2, 3, 4});
    const std::vector<std::size_t> few = thinned(1000, 60);
    CHECK(few.size() <= 61);
    CHECK(few.back() == 999);
    std::vector<double> values(100000, 1.0);
    values[777] = 9;
    values[70001] = -9;
    const std::vector<std::size_t> line = thinned_line(values, 300);
    CHECK(line.size() <= 600);
    CHECK(std::count(line.begin(), line.end(), 777u) == 1);
    CHECK(std::count(line.begin(), line.end(), 70001u) == 1);
    CHECK(std::is_sorted(line.begin(), line.end()));
}

TEST_CASE("chart: a drawing has its words, its marks, and gaps where there is no value") {
    Svg svg(100, 50);
    svg.path({{0, 1}, {1, 2}, {2, none}, {3, 4.126}}, "line");
    svg.mark({none, 1}, 0, "nowhere");
    svg.mark({5, 5}, 14, "here");
    const std::string text = svg.html("id", "title", "described").text();
    CHECK_THAT(text, Contains("d=\"M0 1L1 2M3 4.13\""));
    CHECK_THAT(text, !Contains("nowhere") && Contains("<title>here</title>") && Contains("mark s2"));
    CHECK_THAT(
        text, Contains("role=\"img\" aria-labelledby=\"id-t id-d\"") && Contains("<desc id=\"id-d\">described</desc>"));
}

TEST_CASE("chart: twelve series differ in class and in mark, and those of one colour in shape and filling") {
    std::set<std::string> classes, marks;
    for (std::size_t series = 0; series < 12; ++series) {
        classes.insert(series_class(series));
        Svg svg(10, 10);
        svg.mark({5, 5}, series, {}, series < 6 ? "filled" : "hollow");
        marks.insert(svg.sign("").text());
        Svg own(10, 10);
        own.mark({5, 5}, series, {});
        CHECK((own.sign("").text().find("hollow") != std::string::npos) == (series >= 6));
    }
    CHECK(classes.size() == 12);
    CHECK(marks.size() == 12);
}

TEST_CASE("histogram: every value is counted once, whole numbers have bins of their own, 0 is an edge") {
    std::vector<double> whole;
    for (int i = 0; i < 300; ++i) whole.push_back(i % 3 == 0 ? 4 : 7);
    const Histogram counts = histogram(whole, BinWidths::equal);
    CHECK(counts.edges.front() == 3.5);
    CHECK(counts.counts == std::vector<std::int64_t>{100, 0, 0, 200});
    CHECK(counts.total() == 300);

    std::vector<double> differences;
    for (int i = 0; i < 10000; ++i) differences.push_back(std::sin(i) + 0.3);
    const Histogram signs = histogram(differences, BinWidths::equal);
    CHECK(signs.total() == 10000);
    CHECK(std::count(signs.edges.begin(), signs.edges.end(), 0.0) == 1);
    CHECK(signs.counts.size() >= 20);
    CHECK(signs.counts.size() <= 60);
}

TEST_CASE("histogram: bins of equal ratio are the same for every sample, and far values are counted as beyond") {
    std::vector<double> heavy;
    for (int i = 1; i <= 5000; ++i) heavy.push_back(1.0 / i);
    heavy.push_back(1e12);  // a diverged trial
    const Histogram one = histogram(heavy, BinWidths::ratio);
    CHECK(one.total() == 5001);
    CHECK(one.above >= 1);
    CHECK(one.edges.size() < 150);
    std::vector<double> other{0.05, 0.06, 0.07};
    const Histogram two = histogram(other, BinWidths::ratio);
    for (const double edge : two.edges)
        CHECK(std::any_of(one.edges.begin(), one.edges.end(), [&](double same) { return same == edge; }));
    std::vector<double> empty, negative{-1, 2, 3};
    CHECK(histogram(empty, BinWidths::ratio).counts.empty());
    CHECK(histogram(negative, BinWidths::ratio).total() == 3);
    CHECK(histogram(negative, BinWidths::ratio).widths == BinWidths::equal);
}

}  // namespace credence::test::html_test
