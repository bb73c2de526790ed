#include "worlds/notes.hpp"

#include <credence/text.hpp>
#include <credence/detail/worlds.hpp>

#include <numbers>

namespace credence {

std::vector<std::string> notes_on(const Scenario& scenario) {
    constexpr double large = 1;  // rad: beyond it, a normal angle wraps
    std::vector<std::string> notes;
    for (const DescribedKey& key : world_of(scenario).keys()) {
        if (!key.help.starts_with("sigma") || !key.help.ends_with("(rad)")) continue;
        const std::string value = value_of(scenario, key.key);
        const double sigma = to_number(value).value_or(0);
        if (!(sigma > large)) continue;
        notes.push_back(key.key + "=" + value + " is a standard deviation in rad. If it is in degrees, give " +
                        to_text(sigma * std::numbers::pi / 180) + ".");
    }
    return notes;
}

}  // namespace credence
