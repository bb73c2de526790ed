#pragma once
// Room 13: how the text report writes numbers and tables.

#include <credence/statistics.hpp>

#include <string>
#include <vector>

namespace credence {

/// Left- or right-pads to a width counted in characters, not bytes.
std::string padded(const std::string& text, int width, bool right = true);

/// `-` for NaN.
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

/// `head` and the parts between commas, wrapped and indented.
std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts, std::size_t indent);

}  // namespace credence
