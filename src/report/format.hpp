#pragma once
// Formatting of numbers, sentences and tables in text reports.

#include <credence/statistics.hpp>

#include <string>
#include <vector>

namespace credence {

/// Lines of text have no more characters.
inline constexpr int text_width = 118;

/// The number of characters of UTF-8, not of bytes.
int characters(const std::string& text);

/// Pads to a width, on the left (`right`) or on the right.
std::string aligned(const std::string& text, int width, bool right = true);

/// The same, with at least one blank.
std::string padded(const std::string& text, int width, bool right = true);

/// A number to so many decimals, beyond six of them to ten significant digits at most; `-` where it is not finite, so
/// that neither `nan` nor `inf` appears in a sentence.
std::string number(double value, int digits);

/// Five significant digits, whole numbers in full; `-` for values that are not finite. The same in every locale.
std::string short_number(double value);

/// Decimals that show two digits of the uncertainty; of a value without one four, or as many as show four of its
/// digits.
int decimals_for(double uncertainty, double value = 0);

inline double half_width(const Interval& interval) { return (interval.high - interval.low) / 2; }

/// A half-width to two significant digits at least, and 0 as `0`.
std::string half_width_text(double half, int digits);

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

}  // namespace credence
