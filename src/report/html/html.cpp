#include "report/html/html.hpp"

#include <credence/text.hpp>


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

/// A symbol for each verdict, so that it can be read without colour.
Html symbol_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::consistent: return "&#10003;"_html;  // check mark
        case Verdict::optimistic: return "&#9650;"_html;   // triangle up: NEES above 1
        case Verdict::pessimistic: return "&#9660;"_html;  // triangle down: NEES below 1
        case Verdict::mixed: return "&#9670;"_html;        // diamond
        case Verdict::failed: return "&#10007;"_html;      // ballot x
        case Verdict::undecided: break;
    }
    return "?"_html;
}

Html row_html(const Table::Row& row, const Table& table) {
    if (row.heads_group)
        return "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\""_html +
               escaped(std::to_string(table.heads().size())) + "\">"_html + html_of(row.cells.front()) +
               "</th></tr>\n"_html;
    Html html;
    for (std::size_t c = 0; c < row.cells.size(); ++c)
        html += c < table.row_heads() ? element("th", html_of(row.cells[c]), "scope=\"row\""_html)
                                      : element("td", html_of(row.cells[c]));
    return element("tr", html) + "\n"_html;
}

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
    // U+FFFD.
    for (const char& c : with_controls_as(text, [](std::string_view) { return "\xEF\xBF\xBD"; })) safe += entity(c);
    return Html::trusted(std::move(safe));
}

Html element(std::string_view name, const Html& content, const Html& attributes) {
    std::string text = "<" + std::string(name);
    if (!attributes.empty()) text += " " + attributes.text();
    return Html::trusted(text + ">" + content.text() + "</" + std::string(name) + ">");
}

Html badge(Verdict verdict, const std::string& shown) {
    const bool not_run = shown != verdict_name(verdict);
    return "<span class=\"badge "_html + escaped(verdict_name(verdict)) + "\"><span aria-hidden=\"true\">"_html +
           (not_run ? "&#8211;"_html : symbol_of(verdict)) + "</span> "_html + escaped(shown) + "</span>"_html;
}

Html html_of(const Cell& cell) {
    Html html;
    for (const Cell::Piece& piece : cell.pieces()) {
        Html shown = piece.verdict ? badge(*piece.verdict, piece.shown) : escaped(piece.shown);
        if (piece.exact) shown = element("data", shown, "value=\""_html + escaped(to_text(*piece.exact)) + "\""_html);
        if (!piece.link.empty()) shown = element("a", shown, "href=\"#"_html + escaped(piece.link) + "\""_html);
        html += shown;
    }
    return html;
}

std::string with_powers(std::string text) {
    const std::pair<const char*, const char*> powers[] = {{"^2", "²"}, {"^3", "³"}};
    for (const auto& [plain, raised] : powers)
        for (auto at = text.find(plain); at != std::string::npos; at = text.find(plain)) text.replace(at, 2, raised);
    return text;
}

Html html_of(const Table& table) {
    if (table.empty()) return {};
    Html heads, rows;
    for (const std::string& text : table.heads())
        heads += element("th", escaped(with_powers(text)), "scope=\"col\""_html);
    for (const Table::Row& row : table.rows()) {
        if (row.heads_group && !rows.empty()) rows += "</tbody><tbody>\n"_html;
        rows += row_html(row, table);
    }
    const Html caption = escaped(table.caption());
    const Html html = element("caption", caption) + "\n<thead><tr>"_html + heads + "</tr></thead>\n<tbody>\n"_html +
                      rows + "</tbody>"_html;
    return "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\""_html + caption + "\">"_html +
           element("table", html) + "</div>\n"_html;
}

}  // namespace credence
