#pragma once
// A type for HTML. Text from outside the program becomes HTML only through `escaped`.

#include <credence/statistics.hpp>

#include <string>
#include <string_view>
#include <vector>

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

/// A number formatted for reading, with the exact one (`to_text`) in the attribute `value` of a `data` element. `-`
/// where it is not finite.
Html number_html(double value, int digits);
/// The same with a given text, such as `71 %`.
Html number_html_as(double value, const std::string& text);
/// A count, however large, in full.
Html count_html(double value);
/// `number_html` with the decimals that show two digits of `uncertainty` [src/report/format.hpp].
Html number_html_within(double value, double uncertainty);
/// `[low, high]`, both of them `data` elements; `-` where it does not exist.
Html interval_html(const Interval& interval, int digits);
/// `mean ± half-width`, as in the text report; the mean is a `data` element.
Html mean_html(double mean, const Interval& interval);

/// Five significant digits, whole numbers in full; `-` for values that are not finite. The same in every locale.
std::string short_number(double value);

/// A unit or a name with its powers raised: `dm^2` becomes `dm²`.
std::string with_powers(std::string text);

/// A table with a caption, column heads and row heads. Wide ones are scrolled by themselves, not the page.
class HtmlTable {
public:
    HtmlTable(const std::string& caption, std::vector<std::string> heads);

    /// One cell for each head after the first, which is over the row heads.
    HtmlTable& row(const Html& head, const std::vector<Html>& cells);
    /// A head over the rows that follow.
    HtmlTable& group(const std::string& head);
    bool empty() const { return rows_.empty(); }
    /// Nothing without rows.
    Html html() const;

private:
    std::string caption_;
    std::vector<std::string> heads_;
    Html rows_;
};

}  // namespace credence
