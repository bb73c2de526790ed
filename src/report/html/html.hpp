#pragma once
// A type for HTML. Text from outside the program becomes HTML only through `escaped`.

#include "report/table.hpp"

#include <string>
#include <string_view>

namespace credence {

/// A piece of a page, made of literals of the program, of escaped texts and of other pieces.
class Html {
public:
    Html() = default;
    /// Takes the markup unchanged: only for markup made by this module, never for a text that was read.
    static Html trusted(std::string markup);

    const std::string& text() const { return text_; }
    bool empty() const { return text_.empty(); }
    Html& operator+=(const Html& other);

private:
    std::string text_;
};

Html operator+(Html a, const Html& b);
Html operator""_html(const char* text, std::size_t size);

/// The text with & < > " ' as entities, for elements and for quoted attributes. Control characters, and bytes that are
/// not UTF-8 [text.hpp, with_controls_as], become U+FFFD.
Html escaped(std::string_view text);

/// `<NAME ATTRIBUTES>content</NAME>`; the attributes are inserted unchanged, texts in them must be escaped already.
Html element(std::string_view name, const Html& content, const Html& attributes = {});

/// An arm's verdict as a symbol, a word and a colour; `shown` is the word, or that the arm has not run.
Html badge(Verdict verdict, const std::string& shown);

/// Numbers are `data` elements, with the exact one (`to_text`) in the attribute `value`.
Html html_of(const Cell& cell);

/// The table with its caption. A wide one is scrolled by itself, not the page. Nothing without rows.
Html html_of(const Table& table);

/// A unit or a name with its powers raised: `dm^2` becomes `dm²`.
std::string with_powers(std::string text);

}  // namespace credence
