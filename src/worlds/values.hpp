#pragma once
// Values of scenario keys: their ranges, texts and refusals.

#include <credence/error.hpp>
#include "worlds/deformable/keys.hpp"
#include <credence/text.hpp>

#include <algorithm>

namespace credence {

/// Lengths and angles beyond this are a slip of the pen, and would drown in rounding.
inline constexpr double largest_value = 1e9;

struct ValueRange {
    double low = 0, high = largest_value;
    bool low_included = true;
    bool infinity_allowed = false;
};

inline ValueRange from(double low) { return {low, largest_value, true, false}; }
inline ValueRange above(double low) { return {low, largest_value, false, false}; }
inline ValueRange above_or_infinite(double low) { return {low, largest_value, false, true}; }
inline ValueRange between(double low, double high) { return {low, high, true, false}; }

/// Whether sigma^2 is a number that an inverse can be taken of; `above_least` says so in a remedy.
inline bool has_variance(double sigma) { return sigma * sigma > 1e-200; }
inline const std::string above_least = "above 1e-100";

double parse_real(const std::string& name, const std::string& value, const ValueRange& range);
/// Several between commas, or none. Throws InputError where blanks stand for commas.
std::vector<double> parse_reals(const std::string& name, const std::string& value, const ValueRange& range);
std::string reals_text(const std::vector<double>& values);
std::int64_t parse_integer(const std::string& name, const std::string& value, std::int64_t low, std::int64_t high);
std::size_t parse_choice(const std::string& name, const std::string& value, const std::vector<std::string>& choices);

/// The parts of a list between commas. Throws InputError where blanks stand for commas.
std::vector<std::string> list_parts(const std::string& name, const std::string& value);

/// A list of names of an enumeration, without repeats.
template <class Enum>
std::vector<Enum> parse_names(const std::string& name, const std::string& value,
                              const std::vector<std::string>& names) {
    std::vector<Enum> values;
    for (const std::string& part : list_parts(name, value)) {
        const Enum one = static_cast<Enum>(parse_choice(name, part, names));
        if (std::find(values.begin(), values.end(), one) != values.end())
            throw invalid_value(name, value, part + " is given twice", "Name each once");
        values.push_back(one);
    }
    if (values.empty()) throw invalid_value(name, value, "it is empty", "Give at least one of " + joined(names));
    return values;
}

/// 1 to `most` points as `x y, x y`.
std::vector<Point> parse_points(const std::string& name, const std::string& value, std::size_t most);
std::string positions_text(const std::vector<Point>& positions);
EdgeSettings parse_graph(const std::string& value);
std::string graph_text(const EdgeSettings& edges);
std::optional<double> parse_truncate(const std::string& value);
std::optional<std::vector<double>> parse_turns(const std::string& value);
std::string turns_text(const std::optional<std::vector<double>>& turns);

const std::vector<std::string>& controller_names();
const std::vector<std::string>& estimator_names();
/// The process model that an estimator is for.
Process process_of(Estimator estimator);
std::vector<std::string> estimators_for(Process process);
std::vector<Controller> parse_controllers(const std::string& value);
/// `none`, or names of planners of one's own, each with its version behind a colon where it has one.
std::vector<OwnPlanner> parse_own_planners(const std::string& value);
std::string own_planners_text(const std::vector<OwnPlanner>& planners);
std::optional<std::vector<Estimator>> parse_estimators(const std::string& value);

/// Why a text is refused, or empty where it is good.
std::string is_name(const std::string& value);
std::string is_title(const std::string& value);
std::string is_unit(const std::string& value);

/// The sources that the worlds of SLAM draw from.
const std::vector<DrawSource>& slam_sources();

template <class Enum>
std::string names_text(const std::vector<Enum>& values, const std::vector<std::string>& names) {
    std::vector<std::string> parts;
    for (const Enum value : values) parts.push_back(names[static_cast<std::size_t>(value)]);
    return joined(parts);
}

// A key of one field. `field` gives the field of a scenario, constant or not, as a reference.

template <class S = DeformableSettings, class Field>
KeyOf<S> real_key(const std::string& name, const std::string& help, const ValueRange& range, Field field,
                  const std::string& sigma_unit = {}) {
    return {name, help + (sigma_unit.empty() ? "" : " (" + sigma_unit + ")"),
            [=](S& s, const std::string& v) { field(s) = parse_real(name, v, range); },
            [=](const S& s) { return to_text(field(s)); }, {}, false, sigma_unit};
}

template <class S = DeformableSettings, class Field>
KeyOf<S> integer_key(const std::string& name, const std::string& help, int low, int high, Field field) {
    return {name, help,
            [=](S& s, const std::string& v) { field(s) = static_cast<int>(parse_integer(name, v, low, high)); },
            [=](const S& s) { return std::to_string(field(s)); }};
}

template <class Enum, class S = DeformableSettings, class Field>
KeyOf<S> choice_key(const std::string& name, const std::vector<std::string>& choices, Field field) {
    return {name, joined(choices),
            [=](S& s, const std::string& v) { field(s) = static_cast<Enum>(parse_choice(name, v, choices)); },
            [=](const S& s) { return choices[static_cast<std::size_t>(field(s))]; }, choices};
}

template <class S = DeformableSettings, class Field, class Check>
KeyOf<S> text_key(const std::string& name, const std::string& help, Field field, Check refusal) {
    return {name, help,
            [=](S& s, const std::string& v) {
                const std::string why = refusal(v);
                if (!why.empty()) throw invalid_value(name, v, why, "Give another text");
                field(s) = v;
            },
            [=](const S& s) { return field(s); }};
}

/// The keys that scenarios of every world of ours have.
template <class S>
void add_common_keys(std::vector<KeyOf<S>>& keys) {
    keys.push_back(text_key<S>("scenario.name", "letters, digits, _ and -; unique in a run; default the file's stem",
                               [](auto& s) -> auto& { return s.name; }, is_name));
    keys.push_back(text_key<S>(
        "scenario.title", "one line of text", [](auto& s) -> auto& { return s.title; }, is_title));
    keys.push_back(text_key<S>("scenario.length_unit", "unit of every length, such as dm; lengths are never converted",
                               [](auto& s) -> auto& { return s.length_unit; }, is_unit));
    keys.push_back(integer_key<S>("scenario.poses", "K, the first pose included", 2, largest_pose_count,
                                  [](auto& s) -> auto& { return s.poses; }));
}

}  // namespace credence
