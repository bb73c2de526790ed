#pragma once
// The scenario as text. One table of keys serves the scenario files, `--set`, `credence show`, the stored
// scenario, the study's hash and the documentation.

#include <credence/deformable_settings.hpp>

#include <functional>
#include <string>
#include <vector>

namespace credence {

/// One key `section.name` of a scenario that is a plain struct.
template <class Settings>
struct KeyOf {
    std::string name;     ///< section.key
    std::string help;     ///< one line: meaning, unit, choices
    std::function<void(Settings&, const std::string&)> set;  ///< throws InputError where the value is not in range
    std::function<std::string(const Settings&)> get;         ///< text that `set` reads back to the same value
    std::vector<std::string> choices{};  ///< values, or words among them, to offer; empty: any in range
};
using DeformableKey = KeyOf<DeformableSettings>;

/// All keys, grouped by section, in the order in which they are shown.
const std::vector<DeformableKey>& scenario_keys();

/// Sets `section.key` to a value without its outer blanks; throws InputError for an unknown key (with the closest known
/// one) or a value out of range.
void set_key(DeformableSettings& scenario, const std::string& name, const std::string& value);

}  // namespace credence
