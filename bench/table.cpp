#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace credence::bench {

namespace {

/// Four significant digits, whole numbers and large ones in full.
std::string cell_text(const Json& cell) {
    if (cell.is_string()) return cell.get<std::string>();
    const double value = cell.is_null() ? std::nan("") : cell.get<double>(), size = std::fabs(value);
    if (std::isnan(value)) return "-";
    const int decimals = cell.is_number_integer() || size >= 1000 ? 0
                         : size >= 100                            ? 1
                         : size >= 10                             ? 2
                         : size >= 1                              ? 3
                                                                  : 4;
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

}  // namespace

std::string text_of(const Table& table) {
    std::vector<std::vector<std::string>> lines{table.columns};
    for (const auto& row : table.rows) {
        lines.emplace_back();
        for (const Json& cell : row) lines.back().push_back(cell_text(cell));
    }
    std::vector<std::size_t> widths(table.columns.size());
    for (const auto& line : lines)
        for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
    std::string text = table.title + "\n";
    for (const auto& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            const std::string blanks(widths[c] - line[c].size(), ' ');
            text += c == 0 ? line[c] + blanks : "  " + blanks + line[c];
        }
        text += "\n";
    }
    return text;
}

Json json_of(const Table& table) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json object = Json::object();
        for (std::size_t c = 0; c < row.size(); ++c) object[table.columns[c]] = row[c];
        rows.push_back(object);
    }
    return rows;
}

}  // namespace credence::bench
