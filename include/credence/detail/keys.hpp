#pragma once
// Module worlds: the keys of a scenario. One table for each world serves scenario files, `--set`, `credence show`,
// stored scenarios, the study's hash and the documentation.

#include <credence/error.hpp>
#include <credence/text.hpp>
#include <credence/detail/world.hpp>

#include <functional>
#include <string>
#include <vector>

namespace credence {

/// One key `section.name` of a world's settings, which are a plain struct.
template <class Settings>
struct KeyOf {
    std::string name;     ///< section.key
    std::string help;     ///< one line: meaning, unit, choices
    std::function<void(Settings&, const std::string&)> set;  ///< throws InputError where the value is not in range
    std::function<std::string(const Settings&)> get;         ///< text that `set` reads back to the same value
    std::vector<std::string> choices{};  ///< values, or words among them, to offer; empty: any in range
    /// The key came after studies whose files stay usable: a study's hash leaves it out where it has its default.
    bool later = false;
    std::string sigma_unit{};  ///< the unit of a standard deviation, such as rad; empty for anything else
    bool hidden = false;  ///< a scenario has the key only where it does not have its default
};

/// Throws InputError for a key that is not among `known`, with the closest one that is.
[[noreturn]] void refuse_unknown_key(const std::string& key, const std::vector<std::string>& known);

/// Throws the refusal of a key's value again, with the choice that is nearest to it, or to a part of it, where one is
/// near.
[[noreturn]] void refuse_again(const InputError& refusal, const std::string& value,
                               const std::vector<std::string>& choices);

/// Sets `section.key` to a value without its outer blanks. Throws InputError for an unknown key or a value out of
/// range.
template <class Settings>
void set_key(const std::vector<KeyOf<Settings>>& keys, Settings& settings, const std::string& name,
             const std::string& value) {
    std::vector<std::string> names;
    for (const KeyOf<Settings>& key : keys) {
        names.push_back(key.name);
        if (key.name != name) continue;
        const std::string as_read_back = trimmed(value);
        try {
            return key.set(settings, as_read_back);
        } catch (const InputError& refusal) {
            refuse_again(refusal, as_read_back, key.choices);
        }
    }
    refuse_unknown_key(name, names);
}

// The keys of a budget [docs/budget.md].

/// The bits of sources as `heading, walk`, or `none`. Throws InputError for an unknown one.
std::uint32_t parse_sources(const std::string& value, const std::vector<DrawSource>& sources);
std::string sources_text(std::uint32_t bits, const std::vector<DrawSource>& sources);
KeptErrors parse_kept_errors(const std::string& value);

/// `sources`: all that the world may draw from.
template <class Settings>
void add_budget_keys(std::vector<KeyOf<Settings>>& keys, const std::vector<DrawSource>& sources) {
    std::vector<std::string> names;
    for (const DrawSource& source : sources) names.push_back(source.name);
    keys.push_back({"draws.other", "none, or the sources that draw as in an independent world: any of " + joined(names),
                    [=](Settings& s, const std::string& v) { s.budget.other = parse_sources(v, sources); },
                    [=](const Settings& s) { return sources_text(s.budget.other, sources); }, names});
    keys.push_back({"draws.errors", "steps of which signed errors are columns: " + joined(kept_errors_names()),
                    [](Settings& s, const std::string& v) { s.budget.errors = parse_kept_errors(v); },
                    [](const Settings& s) { return kept_errors_names()[static_cast<std::size_t>(s.budget.errors)]; },
                    kept_errors_names()});
    for (auto key = keys.end() - 2; key != keys.end(); ++key) key->hidden = true;
}

}  // namespace credence
