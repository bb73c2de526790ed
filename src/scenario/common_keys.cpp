// Keys that have the same meaning in every world.

#include <credence/detail/scenario.hpp>

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <cmath>

namespace credence {

namespace {

const std::string published_section = "published.";

double published_value(const std::string& key, const std::string& text) {
    const std::optional<double> value = to_number(text);
    if (!value || !(std::abs(*value) <= 1e9))
        throw invalid_value(key, text, "not a number from -1e+09 to 1e+09",
                            "Give arms with their numbers, such as greedy.kf 0.12");
    return *value;
}

}  // namespace

std::vector<PublishedNumber> parse_published(const std::string& key, const std::string& value) {
    std::vector<PublishedNumber> numbers;
    for (const std::string& part : split_list(value)) {
        const std::size_t space = part.find_first_of(" \t");
        const std::string number = space == std::string::npos ? "" : trimmed(part.substr(space));
        numbers.push_back({part.substr(0, space), published_value(key, number)});
    }
    return numbers;
}

std::string published_text(const std::vector<PublishedNumber>& numbers) {
    std::vector<std::string> parts;
    for (const PublishedNumber& number : numbers) parts.push_back(number.arm + " " + to_text(number.value));
    return joined(parts);
}

std::optional<std::vector<PublishedNumber>> published_for(const Scenario& scenario, const std::string& column) {
    const Setting* published = find_setting(scenario.settings, published_section + column);
    if (published == nullptr) return std::nullopt;
    return parse_published(published->key, published->value);
}

bool is_description(const std::string& key) { return key == "scenario.title" || key.starts_with(published_section); }

bool keeps_the_draws(const std::string& key) {
    if (is_description(key) || key == "scenario.name") return true;
    for (const char* section : {"filter.", "control.", "planner.", "arms."})
        if (key.starts_with(section)) return true;
    return is_of_the_sensor(key);
}

bool is_of_the_sensor(const std::string& key) { return key.starts_with("sensor."); }

}  // namespace credence
