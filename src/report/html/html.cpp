#include "report/html/html.hpp"

#include <credence/text.hpp>

#include "report/format.hpp"

#include <charconv>
#include <cmath>

namespace credence {

namespace {

std::string_view entity(const char& c) {
    switch (c) {
        case '&': return "&amp;";
        case '<': return "&lt;";
        case '>': return "&gt;";
        case '"': return "&quot;";
        case '\'': return "&#39;";
        default: return {&c, 1};
    }
}

Html dash() { return "-"_html; }

}  // namespace

Html Html::trusted(std::string markup) {
    Html html;
    html.text_ = std::move(markup);
    return html;
}

Html& Html::operator+=(const Html& other) {
    text_ += other.text_;
    return *this;
}

Html operator+(Html a, const Html& b) { return a += b; }

Html operator""_html(const char* text, std::size_t size) { return Html::trusted(std::string(text, size)); }

Html escaped(std::string_view text) {
    std::string safe;
    for (const char& c : with_controls_as(text, [](std::string_view) { return "\xEF\xBF\xBD"; })) safe += entity(c);  // U+FFFD
    return Html::trusted(std::move(safe));
}

Html element(std::string_view name, const Html& content, const Html& attributes) {
    std::string text = "<" + std::string(name);
    if (!attributes.empty()) text += " " + attributes.text();
    return Html::trusted(text + ">" + content.text() + "</" + std::string(name) + ">");
}

Html number_html_as(double value, const std::string& text) {
    if (!std::isfinite(value)) return dash();
    return element("data", escaped(text), "value=\""_html + escaped(to_text(value)) + "\""_html);
}

Html number_html(double value, int digits) { return number_html_as(value, number(value, digits)); }

Html count_html(double value) { return number_html_as(value, short_number(value)); }

Html number_html_within(double value, double uncertainty) { return number_html(value, decimals_for(uncertainty)); }

Html interval_html(const Interval& interval, int digits) {
    if (!std::isfinite(half_width(interval))) return dash();
    return "["_html + number_html(interval.low, digits) + ", "_html + number_html(interval.high, digits) + "]"_html;
}

Html mean_html(double mean, const Interval& interval) {
    const double half = half_width(interval);
    const int digits = decimals_for(half);
    if (!std::isfinite(mean) || !std::isfinite(half)) return number_html(mean, digits);
    return number_html(mean, digits) + " ± "_html + escaped(number(half, digits));
}

std::string short_number(double value) {
    if (!std::isfinite(value)) return "-";
    char buffer[64];
    const bool whole = std::abs(value) < 1e15 && (std::abs(value) >= 1e5 || value == std::nearbyint(value));
    const auto end = whole ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 0).ptr
                           : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 5).ptr;
    return std::string(buffer, end);
}

std::string with_powers(std::string text) {
    const std::pair<const char*, const char*> powers[] = {{"^2", "²"}, {"^3", "³"}};
    for (const auto& [plain, raised] : powers)
        for (auto at = text.find(plain); at != std::string::npos; at = text.find(plain)) text.replace(at, 2, raised);
    return text;
}

HtmlTable::HtmlTable(const std::string& caption, std::vector<std::string> heads)
    : caption_(caption), heads_(std::move(heads)) {}

HtmlTable& HtmlTable::row(const Html& head, const std::vector<Html>& cells) {
    rows_ += "<tr><th scope=\"row\">"_html + head + "</th>"_html;
    for (const Html& cell : cells) rows_ += "<td>"_html + cell + "</td>"_html;
    rows_ += "</tr>\n"_html;
    return *this;
}

HtmlTable& HtmlTable::group(const std::string& head) {
    if (!rows_.empty()) rows_ += "</tbody><tbody>\n"_html;
    rows_ += "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\""_html + escaped(std::to_string(heads_.size())) +
             "\">"_html + escaped(head) + "</th></tr>\n"_html;
    return *this;
}

Html HtmlTable::html() const {
    if (empty()) return {};
    Html head;
    for (const std::string& text : heads_) head += element("th", escaped(text), "scope=\"col\""_html);
    const Html table = element("caption", escaped(caption_)) + "\n<thead><tr>"_html + head +
                       "</tr></thead>\n<tbody>\n"_html + rows_ + "</tbody>"_html;
    return "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\""_html + escaped(caption_) + "\">"_html +
           element("table", table) + "</div>\n"_html;
}

}  // namespace credence
