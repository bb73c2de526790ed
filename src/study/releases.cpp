#include "study/releases.hpp"

#include <algorithm>

namespace credence {

namespace {

/// `credence 0.1.` of `credence 0.1.0, git revision 1a2b3c4`; empty if the version is not known.
std::string mixable_part(const std::string& release) {
    const std::size_t major = release.find('.');
    const std::size_t minor = major == std::string::npos ? major : release.find('.', major + 1);
    return minor == std::string::npos ? "" : release.substr(0, minor + 1);
}

}  // namespace

std::string release_name(const std::string& version, const std::string& revision) {
    return "credence " + version + ", git revision " + revision;
}

void note_release(std::vector<std::string>& releases, const std::string& release) {
    if (std::find(releases.begin(), releases.end(), release) == releases.end()) releases.push_back(release);
}

bool may_mix(const std::string& release, const std::string& other) {
    const std::string a = mixable_part(release), b = mixable_part(other);
    return a.empty() || b.empty() || a == b;
}

std::string unmixable(const std::vector<std::string>& releases, const std::string& release) {
    for (const std::string& one : releases)
        if (!may_mix(one, release)) return one;
    return {};
}

std::string why_unmixable(const std::string& other, const std::string& release) {
    return other + " computed trials of it, and this is " + release + "; draws and columns may differ between them";
}

}  // namespace credence
