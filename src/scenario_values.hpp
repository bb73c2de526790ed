#pragma once
// Values of scenario keys: their ranges, texts and refusals.

#include <credence/error.hpp>
#include <credence/scenario_keys.hpp>
#include <credence/text.hpp>

#include <limits>

namespace credence {

/// Lengths and angles beyond this are a slip of the pen, and would drown in rounding.
inline constexpr double largest_value = 1e9;

struct Range {
    double low = 0, high = largest_value;
    bool low_included = true;
    bool infinity_allowed = false;
};

inline Range from(double low) { return {low, largest_value, true, false}; }
inline Range above(double low) { return {low, largest_value, false, false}; }
inline Range above_or_infinite(double low) { return {low, largest_value, false, true}; }
inline Range between(double low, double high) { return {low, high, true, false}; }

double parse_real(const std::string& name, const std::string& value, const Range& range);
std::int64_t parse_integer(const std::string& name, const std::string& value, std::int64_t low, std::int64_t high);
std::size_t parse_choice(const std::string& name, const std::string& value, const std::vector<std::string>& choices);

std::vector<Point> parse_positions(const std::string& value);
std::string positions_text(const std::vector<Point>& positions);
EdgeSettings parse_graph(const std::string& value);
std::string graph_text(const EdgeSettings& edges);
std::optional<double> parse_truncate(const std::string& value);
std::optional<std::vector<double>> parse_turns(const std::string& value);
std::string turns_text(const std::optional<std::vector<double>>& turns);
std::vector<PublishedFigure> parse_published(const std::string& name, const std::string& value);
std::string published_text(const std::vector<PublishedFigure>& figures);

const std::vector<std::string>& controller_names();
const std::vector<std::string>& estimator_names();
/// The process model that an estimator is for.
Process process_of(Estimator estimator);
std::vector<Controller> parse_controllers(const std::string& value);
std::optional<std::vector<Estimator>> parse_estimators(const std::string& value);

/// Why a text is refused, or empty where it is good.
std::string is_name(const std::string& value);
std::string is_title(const std::string& value);
std::string is_unit(const std::string& value);

template <class Enum>
std::string names_text(const std::vector<Enum>& values, const std::vector<std::string>& names) {
    std::vector<std::string> parts;
    for (const Enum value : values) parts.push_back(names[static_cast<std::size_t>(value)]);
    return joined(parts);
}

// A key of one field. `field` gives the field of a scenario, constant or not, as a reference.

template <class Field>
ScenarioKey real_key(const std::string& name, const std::string& help, const Range& range, Field field) {
    return {name, help, [=](Scenario& s, const std::string& v) { field(s) = parse_real(name, v, range); },
            [=](const Scenario& s) { return to_text(field(s)); }};
}

template <class Field>
ScenarioKey integer_key(const std::string& name, const std::string& help, int low, int high, Field field) {
    return {name, help,
            [=](Scenario& s, const std::string& v) { field(s) = static_cast<int>(parse_integer(name, v, low, high)); },
            [=](const Scenario& s) { return std::to_string(field(s)); }};
}

template <class Enum, class Field>
ScenarioKey choice_key(const std::string& name, const std::vector<std::string>& choices, Field field) {
    return {name, joined(choices),
            [=](Scenario& s, const std::string& v) { field(s) = static_cast<Enum>(parse_choice(name, v, choices)); },
            [=](const Scenario& s) { return choices[static_cast<std::size_t>(field(s))]; }, choices};
}

template <class Field, class Check>
ScenarioKey text_key(const std::string& name, const std::string& help, Field field, Check refusal) {
    return {name, help,
            [=](Scenario& s, const std::string& v) {
                const std::string why = refusal(v);
                if (!why.empty()) throw invalid_value(name, v, why, "Give another text");
                field(s) = v;
            },
            [=](const Scenario& s) { return field(s); }};
}

}  // namespace credence
