#include "report_format.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace credence {

std::string padded(const std::string& text, int width, bool right) {
    int characters = 0;
    for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    const std::string space(static_cast<std::size_t>(std::max(1, width - characters)), ' ');  // never glued together
    return right ? space + text : text + space;
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "-";
    char buffer[64];
    const bool vanishes = value != 0 && std::abs(value) < 0.5 * std::pow(10.0, -digits) && digits >= 6;
    if (vanishes) std::snprintf(buffer, sizeof buffer, "%.2g", value);
    else if (std::abs(value) < 1e6) std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
    else std::snprintf(buffer, sizeof buffer, "%.4g", value);
    return buffer;
}

int decimals_for(double uncertainty) {
    if (!(uncertainty > 0) || std::isinf(uncertainty)) return 4;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 6);
}

std::string with_interval(double mean, const Interval& interval) {
    const double half = half_width(interval);
    const int digits = decimals_for(half);
    return std::isnan(half) ? number(mean, digits) : number(mean, digits) + " ± " + number(half, digits);
}

std::string duration_text(double seconds) {
    if (seconds < 10) return number(seconds, 1) + " s";
    if (seconds < 120) return number(seconds, 0) + " s";
    if (seconds < 7200) return number(seconds / 60, 0) + " min";
    return number(seconds / 3600, 1) + " h";
}

std::string bracketed(const Interval& interval, int digits) {
    return std::isnan(interval.low) ? "-" : "[" + number(interval.low, digits) + ", " + number(interval.high, digits) + "]";
}

std::string percent(double share) {
    if (share > 0 && share < 0.005) return "< 1 %";
    if (share > 0.995 && share < 1) return "> 99 %";
    return std::isnan(share) ? "-" : number(100 * share, 0) + " %";
}

std::string p_text(double p) {
    if (std::isnan(p) || p == 1) return std::isnan(p) ? "-" : "1";
    if (p >= 0.001) return number(p, 3);
    if (p < 1e-300) return "< 1e-300";
    char text[32];
    std::snprintf(text, sizeof text, "%.0e", p);
    return text;
}

std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts, std::size_t indent) {
    constexpr std::size_t width = 118;
    std::string text = head;
    std::size_t column = indent + head.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string part = parts[i] + (i + 1 < parts.size() ? "," : "");
        if (column + 1 + part.size() > width && i > 0) {
            text += "\n" + std::string(indent + 2, ' ') + part;
            column = indent + 2 + part.size();
        } else {
            text += " " + part;
            column += 1 + part.size();
        }
    }
    return text;
}

}  // namespace credence
