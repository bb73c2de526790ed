#include "report/format.hpp"

#include <credence/text.hpp>

#include "base/formatted.hpp"

#include <algorithm>
#include <cmath>
#include <charconv>

namespace credence {

int characters(const std::string& text) {
    return static_cast<int>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string aligned(const std::string& text, int width, bool right) {
    const std::string space(static_cast<std::size_t>(std::max(0, width - characters(text))), ' ');
    return right ? space + text : text + space;
}

std::string padded(const std::string& text, int width, bool right) {
    return aligned(text, std::max(width, characters(text) + 1), right);
}

std::string number(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    if (digits > 6 && std::abs(value) < 1e6) {
        if (value == 0) return "0";
        const int significant = digits + 1 + static_cast<int>(std::floor(std::log10(std::abs(value))));
        return formatted("%#.*g", std::clamp(significant, 2, 10), value);
    }
    const bool vanishes = value != 0 && std::abs(value) < 0.5 * std::pow(10.0, -digits) && digits >= 6;
    if (vanishes) return formatted("%.2g", value);
    return std::abs(value) < 1e6 ? formatted("%.*f", digits, value) : formatted("%.4g", value);
}

std::string short_number(double value) {
    if (!std::isfinite(value)) return "-";
    char buffer[64];
    const bool whole = std::abs(value) < 1e15 && (std::abs(value) >= 1e5 || value == std::nearbyint(value));
    const auto end = whole ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 0).ptr
                           : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 5).ptr;
    return std::string(buffer, end);
}

int decimals_for(double uncertainty, double value) {
    const auto decimals = [](double of, int digits) {
        return std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(of))));
    };
    if (uncertainty > 0 && std::isfinite(uncertainty)) return decimals(uncertainty, 2);
    return value != 0 && std::isfinite(value) ? std::max(4, decimals(std::abs(value), 4)) : 4;
}

std::string half_width_text(double half, int digits) { return half == 0 ? "0" : number(half, digits); }

std::string with_interval(double mean, const Interval& interval) {
    const double half = half_width(interval);
    const int digits = decimals_for(half, mean);
    return number(mean, digits) + (std::isfinite(half) ? " ± " + half_width_text(half, digits) : "");
}

std::string duration_text(double seconds) {
    if (seconds < 10) return number(seconds, 1) + " s";
    if (seconds < 120) return number(seconds, 0) + " s";
    if (seconds < 7200) return number(seconds / 60, 0) + " min";
    return number(seconds / 3600, 1) + " h";
}

std::string bracketed(const Interval& interval, int digits) {
    if (!std::isfinite(half_width(interval))) return "-";
    return "[" + number(interval.low, digits) + ", " + number(interval.high, digits) + "]";
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
    return formatted("%.0e", p);
}

namespace {

/// Words with blanks between them, on as many lines as needed; the first begins after `indent` columns.
std::string flowing(const std::vector<std::string>& words, std::size_t indent) {
    std::string text;
    std::size_t column = indent;
    for (const std::string& word : words) {
        const auto size = static_cast<std::size_t>(characters(word));
        if (text.empty()) text = word, column += size;
        else if (column + 1 + size <= std::size_t{text_width}) text += " " + word, column += 1 + size;
        else text += "\n" + std::string(indent + 2, ' ') + word, column = indent + 2 + size;
    }
    return text;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent) { return flowing(split_list(text, ' '), indent); }

std::string wrapped_list(const std::string& head, const std::vector<std::string>& parts, std::size_t indent) {
    std::vector<std::string> words = split_list(head, ' ');
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string part = parts[i] + (i + 1 < parts.size() ? "," : "");
        const bool fits = indent + 2 + static_cast<std::size_t>(characters(part)) <= std::size_t{text_width};
        for (const std::string& word : fits ? std::vector<std::string>{part} : split_list(part, ' '))
            words.push_back(word);
    }
    return flowing(words, indent);
}

}  // namespace credence
