#include <credence/detail/scenario.hpp>

#include <credence/text.hpp>

#include <algorithm>

namespace credence {

const Setting* find_setting(const std::vector<Setting>& settings, const std::string& key) {
    const auto found = std::ranges::find(settings, key, &Setting::key);
    return found == settings.end() ? nullptr : &*found;
}

std::string value_of(const Scenario& scenario, const std::string& key) {
    const Setting* setting = find_setting(scenario.settings, key);
    return setting ? setting->value : "";
}

std::string scenario_text(const Scenario& scenario) {
    std::string text, section;
    for (const auto& [key, value, later_default] : scenario.settings) {
        const std::size_t dot = key.find('.');
        if (key.substr(0, dot) != section) {
            section = key.substr(0, dot);
            text += (text.empty() ? "[" : "\n[") + section + "]\n";
        }
        text += key.substr(dot + 1) + " = " + value + "\n";
    }
    if (const SweepPoint& sweep = scenario.sweep; !sweep.at.empty())
        text += "\n[sweep]\nof = " + sweep.of + "\nat = " + coordinates_text(sweep.at) + "\n";
    return text;
}

bool names_something(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_name_character);
}

bool names_arm(const std::string& text) {
    const std::size_t dot = text.find('.');
    return names_something(text.substr(0, dot)) && (dot == std::string::npos || names_something(text.substr(dot + 1)));
}

std::string controller_of(const std::string& arm) { return arm.substr(0, arm.find('.')); }

std::vector<KeyDifference> key_differences(const Scenario& a, const Scenario& b) {
    std::vector<KeyDifference> differences;
    if (a.world != b.world) differences.push_back({world_key, a.world, b.world});
    const auto note = [&](const std::string& key) {
        if (key == world_key) return;
        const std::string of_a = value_of(a, key), of_b = value_of(b, key);
        if (of_a != of_b) differences.push_back({key, of_a, of_b});
    };
    for (const Setting& setting : a.settings) note(setting.key);
    for (const Setting& setting : b.settings)
        if (find_setting(a.settings, setting.key) == nullptr) note(setting.key);
    return differences;
}

}  // namespace credence
