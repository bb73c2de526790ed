#pragma once
// Module worlds: the keys of the scenario file of a world of somebody's own.

#include <credence/scenario.hpp>
#include <credence/worlds.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// What every world's scenarios have.
struct OwnBasics {
    std::string name = "scenario", title, length_unit = "m";
    int poses = 20;
};

/// The keys of those, with their values as text.
std::vector<DescribedKey> basic_keys(const OwnBasics& basics);
/// Sets one of them; false where the key is none of them. Throws InputError for a bad value.
bool set_basic(OwnBasics& basics, const std::string& key, const std::string& value);

// Texts as numbers. They throw InputError that names the key.
double own_real(const std::string& key, const std::string& text, double low, double high);
int own_integer(const std::string& key, const std::string& text, int low, int high);
std::size_t own_choice(const std::string& key, const std::string& text, const std::vector<std::string>& choices);
std::string own_text(double value);

/// For a key that is not known; `known` are all that are.
[[noreturn]] void refuse_unknown_key(const std::string& key, const std::vector<std::string>& known);

/// A list of keys `section.key`, each of a member of Settings, in the order in which they are shown.
template <class Settings>
class OwnKeys {
public:
    /// A number in [low, high].
    void real(const std::string& key, double Settings::* member, double low, double high, const std::string& help) {
        add(key, help, {}, [=](Settings& s, const std::string& text) { s.*member = own_real(key, text, low, high); },
            [=](const Settings& s) { return own_text(s.*member); });
    }
    /// A whole number in [low, high].
    void integer(const std::string& key, int Settings::* member, int low, int high, const std::string& help) {
        add(key, help, {}, [=](Settings& s, const std::string& text) { s.*member = own_integer(key, text, low, high); },
            [=](const Settings& s) { return std::to_string(s.*member); });
    }
    /// One of several words; the member is an enum that counts them from 0.
    template <class Enum>
    void choice(const std::string& key, Enum Settings::* member, const std::vector<std::string>& choices,
                const std::string& help) {
        add(key, help, choices,
            [=](Settings& s, const std::string& text) { s.*member = static_cast<Enum>(own_choice(key, text, choices)); },
            [=](const Settings& s) { return choices[static_cast<std::size_t>(s.*member)]; });
    }

    // For OwnWorld.
    void set(OwnBasics& basics, Settings& settings, const std::string& key, const std::string& value) const {
        if (set_basic(basics, key, value)) return;
        std::vector<std::string> known;
        for (const DescribedKey& basic : basic_keys(basics)) known.push_back(basic.key);
        for (const Key& own : keys_) {
            if (own.name == key) return own.set(settings, value);
            known.push_back(own.name);
        }
        refuse_unknown_key(key, known);
    }
    std::vector<Setting> settings(const std::string& world, const OwnBasics& basics, const Settings& settings) const {
        std::vector<Setting> all{{world_key, world}};
        for (const DescribedKey& basic : basic_keys(basics)) all.push_back({basic.key, basic.value});
        for (const Key& own : keys_) all.push_back({own.name, own.get(settings)});
        return all;
    }
    std::vector<DescribedKey> described(const Settings& settings) const {
        std::vector<DescribedKey> all = basic_keys({});
        for (const Key& own : keys_) all.push_back({own.name, own.get(settings), own.help, own.choices});
        return all;
    }

private:
    using Set = std::function<void(Settings&, const std::string&)>;
    using Get = std::function<std::string(const Settings&)>;
    struct Key {
        std::string name, help;
        std::vector<std::string> choices;
        Set set;
        Get get;
    };

    void add(const std::string& key, const std::string& help, const std::vector<std::string>& choices, Set set, Get get) {
        keys_.push_back({key, help, choices, std::move(set), std::move(get)});
    }

    std::vector<Key> keys_;
};

}  // namespace credence
