#include "report/table.hpp"

#include <credence/text.hpp>

#include "report/format.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <iterator>

namespace credence {

namespace {

/// How a column is set: as wide as its widest cell, numbers to the right.
struct ColumnLayout {
    int width = 0;
    bool numbers = false;
};

/// The columns of the heads, and those that only rows have; heads of groups are in none.
std::vector<ColumnLayout> layout_of(const Table& table) {
    std::vector<ColumnLayout> columns;
    for (const std::string& head : table.heads()) columns.push_back({characters(head)});
    for (const Table::Row& row : table.rows()) {
        if (row.heads_group) continue;
        columns.resize(std::max(columns.size(), row.cells.size()));
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            columns[c].width = std::max(columns[c].width, characters(row.cells[c].text()));
            columns[c].numbers = columns[c].numbers || row.cells[c].is_number();
        }
    }
    return columns;
}

int width_of(const std::vector<ColumnLayout>& columns) {
    return std::accumulate(columns.begin(), columns.end(), -2,
                           [](int sum, const ColumnLayout& column) { return sum + column.width + 2; });
}

std::vector<std::string> texts_of(const std::vector<Cell>& cells) {
    std::vector<std::string> texts;
    for (const Cell& cell : cells) texts.push_back(cell.text());
    return texts;
}

std::string quoted_for_csv(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string without_end_blanks(std::string line) { return line.substr(0, line.find_last_not_of(' ') + 1) + "\n"; }

/// Writes the lines of a table. Where the row heads do not fit beside the other columns, they have lines of their own.
class TextLines {
public:
    TextLines(const Table& table, int indent)
        : table_(table), columns_(layout_of(table)), indent_(static_cast<std::size_t>(indent)),
          first_(indent + width_of(columns_) <= text_width ? 0 : table.row_heads()) {}

    std::string line(const std::vector<std::string>& cells) const {
        const std::string margin(indent_, ' ');
        std::string text = first_ == 0 ? "" : margin + wrapped_list("", heads_of(cells), indent_) + "\n";
        std::string after = margin + (first_ == 0 ? "" : "  ");
        for (std::size_t c = first_; c < cells.size(); ++c)
            after += (c == first_ ? "" : "  ") + aligned(cells[c], columns_[c].width, columns_[c].numbers);
        return text + without_end_blanks(std::move(after));
    }
    std::string text() const {
        std::string text = line(table_.heads());
        for (const Table::Row& row : table_.rows())
            text += row.heads_group ? std::string(indent_, ' ') + row.cells.front().text() + "\n"
                                    : line(texts_of(row.cells));
        return text;
    }

private:
    std::vector<std::string> heads_of(const std::vector<std::string>& cells) const {
        return {cells.begin(), std::next(cells.begin(), static_cast<std::ptrdiff_t>(std::min(first_, cells.size())))};
    }

    const Table& table_;
    const std::vector<ColumnLayout> columns_;
    const std::size_t indent_, first_;  ///< the first column of the lines
};

}  // namespace

std::string Cell::text() const {
    std::string text;
    for (const Piece& piece : pieces_) text += piece.shown;
    return text;
}

bool Cell::is_number() const {
    return std::any_of(pieces_.begin(), pieces_.end(), [](const Piece& piece) { return piece.exact.has_value(); });
}

Cell operator+(Cell a, const Cell& b) {
    a.pieces_.insert(a.pieces_.end(), b.pieces_.begin(), b.pieces_.end());
    return a;
}

Cell number_cell_as(double value, const std::string& shown) {
    if (!std::isfinite(value)) return "-";
    return Cell::Piece{shown, value};
}

Cell number_cell(double value, int digits) { return number_cell_as(value, number(value, digits)); }

Cell number_cell_within(double value, double uncertainty) {
    return number_cell(value, decimals_for(uncertainty, value));
}

Cell count_cell(double value) { return number_cell_as(value, short_number(value)); }

Cell short_cell(double value) { return short_number(value); }

Cell range_cell(const Interval& interval) {
    if (!std::isfinite(half_width(interval))) return "-";
    return short_number(interval.low) + " to " + short_number(interval.high);
}

Cell interval_cell(const Interval& interval, int digits) {
    if (!std::isfinite(half_width(interval))) return "-";
    return "[" + number_cell(interval.low, digits) + ", " + number_cell(interval.high, digits) + "]";
}

Cell mean_cell(double mean, const Interval& interval) {
    const double half = half_width(interval);
    const int digits = decimals_for(half, mean);
    if (!std::isfinite(mean) || !std::isfinite(half)) return number_cell(mean, digits);
    return number_cell(mean, digits) + " ± " + half_width_text(half, digits);
}

Cell share_cell(double share) { return number_cell_as(share, percent(share)); }

Cell p_cell(double p) { return number_cell_as(p, p_text(p)); }

Cell exact_cell(double value) { return std::isfinite(value) ? Cell(to_text(value)) : Cell(); }

Table& Table::row(std::vector<Cell> cells) {
    rows_.push_back({std::move(cells)});
    return *this;
}

Table& Table::row(Cell head, std::vector<Cell> cells) {
    cells.insert(cells.begin(), std::move(head));
    return row(std::move(cells));
}

Table& Table::group(const std::string& head) {
    rows_.push_back({{head}, true});
    return *this;
}

std::string table_text(const Table& table, int indent) { return table.empty() ? "" : TextLines(table, indent).text(); }

std::string csv_row(const std::vector<Cell>& cells) {
    std::vector<std::string> texts;
    for (const Cell& cell : cells) {
        std::string text;
        for (const Cell::Piece& piece : cell.pieces()) text += piece.exact ? to_text(*piece.exact) : piece.shown;
        texts.push_back(quoted_for_csv(text));
    }
    return joined(texts, ",") + "\n";
}

}  // namespace credence
