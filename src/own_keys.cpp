#include <credence/own_keys.hpp>

#include <credence/text.hpp>

#include "scenario_values.hpp"

namespace credence {

std::vector<DescribedKey> basic_keys(const OwnBasics& basics) {
    return {{"scenario.name", basics.name, "letters, digits, _ and -; unique in a run; default the file's stem"},
            {"scenario.title", basics.title, "one line of text"},
            {"scenario.length_unit", basics.length_unit, "unit of every length; lengths are never converted"},
            {"scenario.poses", std::to_string(basics.poses), "K, the first included: K - 1 steps"}};
}

bool set_basic(OwnBasics& basics, const std::string& key, const std::string& value) {
    const auto checked = [&](const std::string& why) {
        if (!why.empty()) throw invalid_value(key, value, why, "Give another text");
        return value;
    };
    if (key == "scenario.name") basics.name = checked(is_name(value));
    else if (key == "scenario.title") basics.title = checked(is_title(value));
    else if (key == "scenario.length_unit") basics.length_unit = checked(is_unit(value));
    else if (key == "scenario.poses") basics.poses = own_integer(key, value, 2, largest_pose_count);
    else return false;
    return true;
}

double own_real(const std::string& key, const std::string& text, double low, double high) {
    return parse_real(key, text, between(low, high));
}

int own_integer(const std::string& key, const std::string& text, int low, int high) {
    return static_cast<int>(parse_integer(key, text, low, high));
}

std::size_t own_choice(const std::string& key, const std::string& text, const std::vector<std::string>& choices) {
    return parse_choice(key, text, choices);
}

std::string own_text(double value) { return to_text(value); }

void refuse_unknown_key(const std::string& key, const std::vector<std::string>& known) {
    const std::string meant = closest(key, known);
    throw InputError("unknown key " + printable(key) + ". " +
                         (meant.empty() ? "The keys are " + joined(known) + "." : "Did you mean " + meant + "?"),
                     key);
}

}  // namespace credence
