#pragma once
// Formatting of numbers, sentences and tables in text reports.

#include <credence/statistics.hpp>

#include <string>
#include <vector>

namespace credence {

/// Left- or right-pads to a width counted in characters, not bytes.
std::string padded(const std::string& text, int width, bool right = true);

/// A number; `-` where it is not finite, so that neither `nan` nor `inf` appears in a sentence.
std::string number(double value, int digits);

/// Decimals that show two digits of the uncertainty, at most 6.
int decimals_for(double uncertainty);

inline double half_width(const Interval& interval) { return (interval.high - interval.low) / 2; }

/// `mean ± half-width`
std::string with_interval(double mean, const Interval& interval);

/// `75 s`, `12 min`, `3.4 h`.
std::string duration_text(double seconds);

/// `[low, high]`, or `-`.
std::string bracketed(const Interval& interval, int digits);

/// A share in whole percents; 0 % and 100 % are used only for none and all.
std::string percent(double share);

/// A p-value: three decimals, below 0.001 its order of magnitude.
std::string p_text(double p);

/// A sentence on lines of less than 120 columns, of which the first begins after `indent` columns and the others two
/// further.
std::string wrapped(const std::string& text, std::size_t indent = 0);

/// The same for `head` and parts separated by commas, each of which stays on one line where it can.
std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts, std::size_t indent);

/// A table with columns as wide as their content, two blanks apart.
class TextTable {
public:
    /// `l` or `r` for each column, to the left or to the right; the last one stands for all further ones.
    explicit TextTable(std::string alignment) : alignment_(std::move(alignment)) {}
    void row(std::vector<std::string> cells);
    /// A line between the rows, printed unchanged.
    void line(std::string text);
    /// Whether its rows have less than 120 columns.
    bool fits() const;
    std::string text() const;

private:
    struct Row {
        std::vector<std::string> cells;
        std::string line;
    };
    std::string alignment_;
    std::vector<std::size_t> widths_;
    std::vector<Row> rows_;
};

}  // namespace credence
