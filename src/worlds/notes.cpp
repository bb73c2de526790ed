#include "worlds/notes.hpp"

#include <credence/text.hpp>
#include <credence/detail/worlds.hpp>

#include <numbers>
#include <set>

namespace credence {

std::vector<std::string> notes_on(const std::vector<Scenario>& scenarios) {
    constexpr double large = 1;  // rad: beyond it, a normal angle wraps
    std::vector<std::string> notes;
    std::set<std::string> noted;  // keys: a sweep may have many such values of one
    for (const Scenario& scenario : scenarios)
        for (const DescribedKey& key : world_of(scenario).keys()) {
            if (key.sigma_unit != "rad") continue;
            const std::string value = value_of(scenario, key.key);
            const double sigma = to_number(value).value_or(0);
            if (!(sigma > large) || !noted.insert(key.key).second) continue;
            notes.push_back(key.key + "=" + value + " is a standard deviation in rad. If it is in degrees, give " +
                            to_text(sigma * std::numbers::pi / 180) + ".");
        }
    return notes;
}

}  // namespace credence
