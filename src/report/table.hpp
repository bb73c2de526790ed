#pragma once
// Tables of numbers as a report has them, rendered as text and CSV here, and as HTML by report/html.

#include <credence/consistency.hpp>
#include <credence/statistics.hpp>

#include <optional>
#include <string>
#include <vector>

namespace credence {

/// The content of a cell: words, and numbers that are shown rounded and keep their exact value.
class Cell {
public:
    struct Piece {
        std::string shown;
        std::optional<double> exact{};      ///< of a number
        std::string link{};                 ///< the section of a page that the words lead to
        std::optional<Verdict> verdict{};   ///< of an arm; its colour and symbol on a page
    };

    Cell() = default;
    Cell(std::string words) : pieces_{{std::move(words)}} {}
    Cell(const char* words) : Cell(std::string(words)) {}
    Cell(Piece piece) : pieces_{std::move(piece)} {}

    const std::vector<Piece>& pieces() const { return pieces_; }
    std::string text() const;
    bool is_number() const;
    friend Cell operator+(Cell a, const Cell& b);

private:
    std::vector<Piece> pieces_;
};

/// A number as a given text, such as `71 %`; `-` where it is not finite.
Cell number_cell_as(double value, const std::string& shown);
Cell number_cell(double value, int digits);
/// With the decimals that show two digits of `uncertainty`.
Cell number_cell_within(double value, double uncertainty);
/// A count, however large, in full.
Cell count_cell(double value);
/// Five significant digits, and a range of them, without the exact values: a page has thousands of these.
Cell short_cell(double value);
Cell range_cell(const Interval& interval);
/// `[low, high]`; `-` where it does not exist.
Cell interval_cell(const Interval& interval, int digits);
/// `mean ± half-width`
Cell mean_cell(double mean, const Interval& interval);
/// A share in whole percents.
Cell share_cell(double share);
Cell p_cell(double p);

/// The exact number as words, for CSV; nothing where it is not finite.
Cell exact_cell(double value);

/// A table with column heads. The first columns are the row heads.
class Table {
public:
    struct Row {
        std::vector<Cell> cells;
        bool heads_group = false;           ///< a head over the rows that follow
    };

    Table(std::string caption, std::vector<std::string> heads, std::size_t row_heads = 1)
        : caption_(std::move(caption)), heads_(std::move(heads)), row_heads_(row_heads) {}

    /// One cell for each column head; further ones may be missing.
    Table& row(std::vector<Cell> cells);
    /// The same with the row head by itself.
    Table& row(Cell head, std::vector<Cell> cells);
    Table& group(const std::string& head);
    bool empty() const { return rows_.empty(); }
    const std::string& caption() const { return caption_; }
    const std::vector<std::string>& heads() const { return heads_; }
    const std::vector<Row>& rows() const { return rows_; }
    std::size_t row_heads() const { return row_heads_; }

private:
    std::string caption_;
    std::vector<std::string> heads_;
    std::size_t row_heads_;
    std::vector<Row> rows_;
};

/// The table without its caption: columns as wide as their content, two blanks apart; those of words to the left. Row
/// heads that would make lines longer than `text_width` have lines of their own. Nothing without rows.
std::string table_text(const Table& table, int indent = 2);

/// A row as CSV, with the exact numbers, and quoted where that is needed [RFC 4180].
std::string csv_row(const std::vector<Cell>& cells);

}  // namespace credence
