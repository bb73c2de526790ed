#pragma once
// The keys of the deformable world [docs/model.md].

#include <credence/detail/deformable_settings.hpp>
#include <credence/detail/keys.hpp>

#include <string>
#include <vector>

namespace credence {

using DeformableKey = KeyOf<DeformableSettings>;

/// All keys, grouped by section, in the order in which they are shown.
const std::vector<DeformableKey>& scenario_keys();

/// Sets `section.key` to a value without its outer blanks; throws InputError for an unknown key (with the closest known
/// one) or a value out of range.
void set_key(DeformableSettings& scenario, const std::string& name, const std::string& value);

/// The settings as text [scenario.hpp], as they are: neither resolved nor validated.
std::string scenario_text(const DeformableSettings& scenario);

}  // namespace credence
