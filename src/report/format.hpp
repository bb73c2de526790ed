#pragma once
// How text reports write numbers, sentences and tables.

#include <credence/statistics.hpp>

#include <string>
#include <vector>

namespace credence {

/// Left- or right-pads to a width counted in characters, not bytes.
std::string padded(const std::string& text, int width, bool right = true);

/// `-` for what is not finite: neither `nan` nor `inf` gets into a sentence.
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

/// A share in whole percents; only what is none or all says so.
std::string percent(double share);

/// A p-value: three decimals, below 0.001 its order of magnitude.
std::string p_text(double p);

/// A sentence on lines of less than 120 columns, of which the first begins behind `indent` columns and the others two further.
std::string wrapped(const std::string& text, std::size_t indent = 0);

/// The same of `head` and the parts between commas, each of which stays whole where it can.
std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts, std::size_t indent);

/// Columns as wide as what they hold, each two blanks from the one before.
class TextTable {
public:
    /// `l` or `r` for each column, to the left or to the right; the last one stands for all further ones.
    explicit TextTable(std::string alignment) : alignment_(std::move(alignment)) {}
    void row(std::vector<std::string> cells);
    /// Between the rows, as it is.
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
