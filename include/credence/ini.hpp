#pragma once
// Module worlds: reading scenario files: INI, line by line through Boost.Program_options, so that a message can name
// the line.

#include <credence/detail/scenario.hpp>
#include <credence/detail/deformable_settings.hpp>

#include <string>
#include <utility>
#include <vector>

namespace credence {

/// `section.key` and value, as given by --set. Later ones win.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// The scenario of a text, with overrides, resolved and validated. `origin` names the text in messages (a file, or a
/// group of a results file); `default_name` is its name where it gives none.
/// Throws InputError: unknown or repeated key, broken line, value out of range, keys that contradict each other.
DeformableSettings read_deformable_text(const std::string& text, const std::string& origin,
                                        const std::string& default_name, const Overrides& overrides = {});

/// The same from a file of at most 1 MiB; the default name is the file's stem.
DeformableSettings read_deformable(const std::string& path, const Overrides& overrides = {});

/// The same for a scenario of any world: `scenario.world` says which, the deformable one where it is not given.
Scenario read_scenario_text(const std::string& text, const std::string& origin, const std::string& default_name,
                                  const Overrides& overrides = {});
Scenario read_scenario(const std::string& path, const Overrides& overrides = {});

/// The scenarios of a file's sweep, in the sweep's order: each with the overrides, then its values of the axes, and
/// named after its place [point_name]. Without axes: the file's own scenario. Throws InputError, naming the point.
std::vector<Scenario> read_grid(const std::string& path, const Overrides& overrides,
                                   const std::vector<SweepAxis>& axes);

/// The keys and values of a text, uninterpreted. Throws InputError for broken lines and repeated keys.
std::vector<Setting> read_settings(const std::string& text, const std::string& origin);

}  // namespace credence
