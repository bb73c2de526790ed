#pragma once
// Module scenario: a scenario of any world, as engine, files and program know it: its name, what it reports, and its
// settings as text. Its world knows what the settings mean [worlds.hpp].

#include <credence/columns.hpp>
#include <credence/detail/sweep.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// `section.key` and its value, as they stand in a scenario file.
struct Setting {
    std::string key, value;
    bool later_default = false;  ///< the default of a key that a study's hash leaves out there [detail/keys.hpp]
    friend bool operator==(const Setting&, const Setting&) = default;
};

/// The world of a scenario that names none.
inline const std::string first_world = "deformable";
/// The key that names another.
inline const std::string world_key = "scenario.world";

/// A resolved scenario.
struct Scenario {
    std::string world = first_world;
    std::string name = "scenario";
    std::string title;
    std::string length_unit = "dm";
    int poses = 20;                      ///< K, the first included: K - 1 steps
    std::vector<Setting> settings;       ///< every key of it, in the order in which they are shown
    std::vector<Component> components;   ///< of the state, [n]
    std::vector<ComponentGroup> groups;  ///< that are judged by themselves, the whole state (`all`) first
    std::vector<std::string> arms;       ///< `controller.estimator`, in the order in which they run
    std::vector<std::string> baselines;  ///< by arm: the arm that it is compared with; empty: none
    SweepPoint sweep{};                  ///< its place in a grid; empty: in none
    /// The settings as its world's own type: of a scenario that its world made, so that they are read from text once.
    std::shared_ptr<const void> own_settings{};
};

/// A scenario as an INI text that names every key, and its place in a grid where it has one. Reading it back gives the
/// same scenario.
std::string scenario_text(const Scenario& scenario);

/// Whether a text is a name: letters, digits, _ and -; and whether it is that of an arm: a name, or two with a point
/// between them.
bool names_something(const std::string& text);
bool names_arm(const std::string& text);

/// The controller in an arm's name.
std::string controller_of(const std::string& arm);

/// The setting of that key, or nullptr.
const Setting* find_setting(const std::vector<Setting>& settings, const std::string& key);

/// A key's value; empty where the scenario has no such key.
std::string value_of(const Scenario& scenario, const std::string& key);

// Keys and sections that have the same meaning in every world. The worlds of users may have them too.

/// The value of a key `published.COLUMN`, such as `fixed.kf 0.12, greedy.kf 0.1`. Throws InputError where one is no
/// number.
std::vector<PublishedNumber> parse_published(const std::string& key, const std::string& value);
std::string published_text(const std::vector<PublishedNumber>& numbers);
/// Those of a column; nothing where the scenario has no such key.
std::optional<std::vector<PublishedNumber>> published_for(const Scenario& scenario, const std::string& column);

/// Whether a key describes the scenario only, so that no number of a study depends on it: its title, published numbers.
bool is_description(const std::string& key);

/// Whether the trials of scenarios that differ in the key share their draws, so that they can be compared as pairs:
/// descriptions and names, and the sections filter, control, planner, arms and sensor.
bool keeps_the_draws(const std::string& key);

/// Whether scenarios that differ in the key are of different worlds: where keeps_the_draws, those of the section
/// sensor.
bool is_of_the_sensor(const std::string& key);

/// A key in which two scenarios differ, with both values; empty where one of them has no such key.
struct KeyDifference {
    std::string key, a, b;
};
std::vector<KeyDifference> key_differences(const Scenario& a, const Scenario& b);

}  // namespace credence
