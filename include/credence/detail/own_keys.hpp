#pragma once
// Module worlds: the keys of the scenario file of a user's own world.

#include <credence/detail/keys.hpp>

#include <functional>
#include <string>
#include <vector>

namespace credence {

/// What the scenarios of every world have.
struct OwnBasics {
    std::string name = "scenario", title, length_unit = "m";
    int poses = 20;
    BudgetSettings budget{};
};

/// Those, and the settings of a user's own world.
template <class Settings>
struct OwnSettings : OwnBasics {
    Settings own;
};

/// The keys that the scenarios of every world have.
const std::vector<KeyOf<OwnBasics>>& basic_keys();

/// The sources of a world of one's own: the names of its sources 0, 1 ...
std::vector<DrawSource> own_sources(const std::vector<std::string>& names);

// Texts as numbers. They throw InputError that names the key.
double own_real(const std::string& key, const std::string& text, double low, double high);
int own_integer(const std::string& key, const std::string& text, int low, int high);
std::size_t own_choice(const std::string& key, const std::string& text, const std::vector<std::string>& choices);
std::vector<double> own_reals(const std::string& key, const std::string& text, double low, double high);
std::string own_text(double value);
std::string own_text(const std::vector<double>& values);

/// A list of keys `section.key`, each of a member of Settings, in the order in which they are shown.
template <class Settings>
class OwnKeys {
public:
    OwnKeys() {
        for (const KeyOf<OwnBasics>& basic : basic_keys())
            keys_.push_back({basic.name, basic.help, basic.set, basic.get, basic.choices});
    }

    /// A number in [low, high]. Of a standard deviation its unit may be given, which help then shows: in rad, a value
    /// above 1 is noted.
    void real(const std::string& key, double Settings::* member, double low, double high, const std::string& help,
              const std::string& sigma_unit = {}) {
        add(key, help + (sigma_unit.empty() ? "" : " (" + sigma_unit + ")"), {},
            [=](Settings& s, const std::string& text) { s.*member = own_real(key, text, low, high); },
            [=](const Settings& s) { return own_text(s.*member); });
        keys_.back().sigma_unit = sigma_unit;
    }
    /// A whole number in [low, high].
    void integer(const std::string& key, int Settings::* member, int low, int high, const std::string& help) {
        add(key, help, {}, [=](Settings& s, const std::string& text) { s.*member = own_integer(key, text, low, high); },
            [=](const Settings& s) { return std::to_string(s.*member); });
    }
    /// One number or more in [low, high], separated by commas. What a list's length must be, `validate` says.
    void reals(const std::string& key, std::vector<double> Settings::* member, double low, double high,
               const std::string& help) {
        add(key, help, {}, [=](Settings& s, const std::string& text) { s.*member = own_reals(key, text, low, high); },
            [=](const Settings& s) { return own_text(s.*member); });
    }
    /// One of several words; the member is an enum that counts them from 0.
    template <class Enum>
    void choice(const std::string& key, Enum Settings::* member, const std::vector<std::string>& choices,
                const std::string& help) {
        add(
            key, help, choices,
            [=](Settings& s, const std::string& text) {
                s.*member = static_cast<Enum>(own_choice(key, text, choices));
            },
            [=](const Settings& s) {
                const auto place = static_cast<std::size_t>(s.*member);
                return place < choices.size() ? choices[place] : std::to_string(place);  // which `set` refuses
            });
    }

    /// Those of a budget, of a world that names its sources.
    void budget(const std::vector<DrawSource>& sources) { add_budget_keys(keys_, sources); }

    /// All of them, those of every world first.
    const std::vector<KeyOf<OwnSettings<Settings>>>& list() const { return keys_; }

private:
    using Set = std::function<void(Settings&, const std::string&)>;
    using Get = std::function<std::string(const Settings&)>;
    using All = OwnSettings<Settings>;

    void add(const std::string& key, const std::string& help, const std::vector<std::string>& choices, Set set,
             Get get) {
        keys_.push_back({key, help, [set](All& s, const std::string& text) { set(s.own, text); },
                         [get](const All& s) { return get(s.own); }, choices});
    }

    std::vector<KeyOf<All>> keys_;
};

}  // namespace credence
