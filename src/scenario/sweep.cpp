#include <credence/detail/sweep.hpp>

#include <credence/error.hpp>
#include <credence/detail/scenario.hpp>
#include <credence/text.hpp>

#include "base/wording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace credence {

namespace {

/// Without a remedy: how to write one.
InputError invalid_sweep(const std::string& text, const std::string& why, const std::string& remedy = {}) {
    return invalid_value(as_option("sweep"), text, why,
                         remedy.empty() ? "Write " + as_option("sweep", "section.key=a,b,c") : remedy);
}

/// Names, units and what is shown beside the series make no other study; another world has other keys.
bool can_be_swept(const std::string& key) {
    for (const char* name : {"scenario.name", "scenario.length_unit", "scenario.world"})
        if (key == name) return false;
    return !is_description(key) && !key.starts_with("sweep.");
}

/// A value with every number in it as `to_text` writes it: 1e-2 is 0.01, so that the same values have the same text.
std::string written_alike(const std::string& value) {
    std::vector<std::string> parts;
    for (const std::string& part : split_list(value)) {
        std::vector<std::string> words;
        for (const std::string& word : split_list(part, ' ')) {
            const std::optional<double> number = to_number(word);
            if (!word.empty()) words.push_back(number ? to_text(*number) : word);
        }
        parts.push_back(joined(words, " "));
    }
    return joined(parts);
}

/// The number that six digits of it make, or all digits down to a decimal place.
double rounded(double value, std::chars_format format, int precision) {
    char buffer[1024];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, format, precision).ptr;
    std::from_chars(buffer, end, value, format);
    return value == 0 ? 0 : value;  // never -0
}

/// A range of numbers as it was asked for.
struct NumberRange {
    double first = 0, last = 0;
    std::size_t count = 0;
    bool geometric = false;

    double at(std::size_t i) const {
        if (i == 0 || i + 1 == count) return i == 0 ? first : last;
        const double share = static_cast<double>(i) / static_cast<double>(count - 1);
        if (geometric) return rounded(first * std::pow(last / first, share), std::chars_format::scientific, 5);
        const double step = std::abs(last - first) / static_cast<double>(count - 1);
        const int decimals = std::clamp(5 - static_cast<int>(std::floor(std::log10(step))), 0, 300);
        return rounded(first * (1 - share) + last * share, std::chars_format::fixed, decimals);
    }
};

NumberRange parse_range(const std::string& text, const std::string& item) {
    const std::vector<std::string> parts = split_list(item, ':');
    const std::string form = "Write first:last:count or first:last:count:log, such as 0.001:0.1:5:log";
    if (parts.size() < 3 || parts.size() > 4 || (parts.size() == 4 && parts[3] != "log"))
        throw invalid_sweep(text, "'" + item + "' is not a range", form);
    const std::optional<double> first = to_number(parts[0]), last = to_number(parts[1]);
    const std::optional<std::int64_t> count = to_integer(parts[2]);
    if (!first || !last || !std::isfinite(*first) || !std::isfinite(*last))
        throw invalid_sweep(text, "the ends of '" + item + "' are not numbers", form);
    if (!count || *count < 2 || *count > static_cast<std::int64_t>(most_swept_scenarios))
        throw invalid_sweep(text, "'" + item + "' needs 2 to " + std::to_string(most_swept_scenarios) + " points",
                            form);
    if (*first == *last) throw invalid_sweep(text, "the ends of '" + item + "' are the same", form);
    const bool geometric = parts.size() == 4;
    if (geometric && !(*first > 0 && *last > 0))
        throw invalid_sweep(text, "a range with log has ends above 0", "Give other ends, or leave :log out");
    return {*first, *last, static_cast<std::size_t>(*count), geometric};
}

/// A value as a part of a name; empty where it cannot be one.
std::string name_part(const std::string& value) {
    constexpr std::size_t longest = 24;
    std::string name;
    const bool number = to_number(value).has_value();
    for (std::size_t i = 0; i < value.size(); ++i) {
        const char c = value[i];
        if (c == '.') name += 'p';
        else if (number && c == '-' && i == 0) name += 'm';
        else if (is_name_character(c)) name += c;
        else if (!number && !name.empty() && name.back() != '_') name += '_';
    }
    return name.size() > longest ? "" : name;
}

std::string after_dot(const std::string& key) { return key.substr(key.find('.') + 1); }

/// The axis's part of a name: its key, shortened where that is clear, and the value or its number.
std::string axis_part(const std::vector<SweepAxis>& axes, std::size_t a, const std::string& value) {
    const SweepAxis& axis = axes[a];
    const bool clear = std::count_if(axes.begin(), axes.end(), [&](const SweepAxis& other) {
                           return after_dot(other.key) == after_dot(axis.key);
                       }) == 1;
    std::string key = clear ? after_dot(axis.key) : axis.key;
    std::replace(key.begin(), key.end(), '.', '-');
    std::set<std::string> names;
    for (const std::string& one : axis.values) names.insert(name_part(one));
    const auto place = std::find(axis.values.begin(), axis.values.end(), value) - axis.values.begin();
    const bool fit = names.size() == axis.values.size() && names.count("") == 0;
    return key + "-" + (fit ? name_part(value) : "v" + std::to_string(place));
}

}  // namespace

std::string coordinates_text(const std::vector<SweepCoordinate>& at) {
    std::vector<std::string> parts;
    for (const SweepCoordinate& one : at) parts.push_back(one.key + "=" + one.value);
    return joined(parts);
}

std::vector<SweepCoordinate> parse_coordinates(const std::string& text) {
    std::vector<SweepCoordinate> at;
    const auto refuse = [&](const std::string& why) {
        return invalid_value("sweep.at", text, why, "Write section.key=value, section.key=value");
    };
    for (const std::string& part : split_list(text)) {
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos && at.empty()) throw refuse("'" + part + "' names no key");
        if (equals == std::string::npos) {
            at.back().value += ", " + part;
            continue;
        }
        const std::string key = trimmed(part.substr(0, equals));
        for (const SweepCoordinate& other : at)
            if (other.key == key) throw refuse(key + " is given twice");
        if (!can_be_swept(key)) throw refuse("no grid can be over " + key);
        at.push_back({key, trimmed(part.substr(equals + 1))});
        if (at.back().value.empty()) throw refuse(key + " has no value");
    }
    for (SweepCoordinate& one : at) one.value = written_alike(one.value);
    return at;
}

SweepAxis parse_axis(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw invalid_sweep(text, "there is no = in it");
    SweepAxis axis{trimmed(text.substr(0, equals)), {}};
    if (axis.key == "scenario.world") throw invalid_sweep(text, "a grid is of one world", "Give a scenario of each");
    if (!can_be_swept(axis.key))
        throw invalid_sweep(text, axis.key + " changes nothing that is computed", "Sweep another key");
    const std::string items = text.substr(equals + 1);
    const char separator = items.find('|') == std::string::npos ? ',' : '|';
    std::vector<std::string> listed = split_list(items, separator);
    if (separator == '|' && listed.size() > 1 && listed.back().empty()) listed.pop_back();  // `0, 0.3|`: one value
    for (const std::string& item : listed) {
        if (item.empty()) throw invalid_sweep(text, "a value is empty");
        if (item.find(':') == std::string::npos) {
            axis.values.push_back(written_alike(item));
            continue;
        }
        const NumberRange range = parse_range(text, item);
        for (std::size_t i = 0; i < range.count; ++i) axis.values.push_back(to_text(range.at(i)));
    }
    if (axis.values.empty()) throw invalid_sweep(text, "it has no value");
    return axis;
}

std::vector<SweepAxis> parse_grid(const std::vector<std::string>& texts) {
    std::vector<SweepAxis> axes;
    std::size_t points = 1;
    for (const std::string& text : texts) {
        SweepAxis axis = parse_axis(text);
        for (const SweepAxis& other : axes)
            if (other.key == axis.key)
                throw invalid_sweep(text, axis.key + " is swept twice",
                                    "Give all its values in one " + as_option("sweep"));
        std::set<std::string> values;
        for (const std::string& value : axis.values)
            if (!values.insert(value).second)
                throw invalid_sweep(text, value + " is given twice", "Give each value once");
        points *= axis.values.size();  // no product overflows: the factor before is at most the limit
        if (points > most_swept_scenarios)
            throw invalid_sweep(text, "the grid has more than " + std::to_string(most_swept_scenarios) + " points",
                                "Give fewer values, or a study for each part");
        axes.push_back(std::move(axis));
    }
    return axes;
}

std::size_t point_count(const std::vector<SweepAxis>& axes) {
    std::size_t points = 1;
    for (const SweepAxis& axis : axes) points *= axis.values.size();
    return points;
}

std::vector<std::vector<SweepCoordinate>> grid_points(const std::vector<SweepAxis>& axes) {
    std::vector<std::vector<SweepCoordinate>> points{{}};
    for (const SweepAxis& axis : axes) {
        std::vector<std::vector<SweepCoordinate>> longer;
        for (const std::vector<SweepCoordinate>& point : points)
            for (const std::string& value : axis.values) {
                longer.push_back(point);
                longer.back().push_back({axis.key, value});
            }
        points = std::move(longer);
    }
    return points;
}

std::string point_name(const std::string& of, const std::vector<SweepAxis>& axes,
                       const std::vector<SweepCoordinate>& point) {
    std::string name = of;
    for (std::size_t a = 0; a < axes.size(); ++a) name += "_" + axis_part(axes, a, point[a].value);
    return name;
}

}  // namespace credence
