#pragma once
// Which releases of credence computed trials of a study.

#include <string>
#include <vector>

namespace credence {

/// The name of a release that is not known.
inline const std::string unknown_release = "an unknown release";

/// `credence VERSION, git revision REVISION`
std::string release_name(const std::string& version, const std::string& revision);

/// Adds a release to a list that names each once.
void note_release(std::vector<std::string>& releases, const std::string& release);

/// Whether results of two releases, both of the same schema version, may be in one file: they agree in the first two
/// numbers of their version, or that of one is not known.
bool may_mix(const std::string& release, const std::string& other);

/// The first release in the list that may not be mixed with this one; empty if there is none.
std::string unmixable(const std::vector<std::string>& releases, const std::string& release);

/// Why trials that `other` computed may not be mixed with those of `release`, for a message about their file.
std::string why_unmixable(const std::string& other, const std::string& release);

}  // namespace credence
