// Scenario texts and overrides: each is refused by an InputError of one line, or becomes a scenario that is valid, that
// its own text gives again, and that a problem can be made of.

#include "require.hpp"
#include "scenario_mutator.hpp"

#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/detail/worlds.hpp>

#include <cstdint>
#include <optional>

using namespace credence;
using namespace credence::fuzz;

namespace {

struct Input {
    std::string text;
    Overrides overrides;
};

Input split(const std::string& bytes) {
    Input input;
    std::size_t end = std::min(bytes.find(override_separator), bytes.size());
    input.text = bytes.substr(0, end);
    while (end < bytes.size()) {
        const std::size_t first = end + 1;
        end = std::min(bytes.find(override_separator, first), bytes.size());
        const std::string assignment = bytes.substr(first, end - first);
        const std::size_t sign = assignment.find('=');
        if (sign == std::string::npos) continue;
        input.overrides.emplace_back(assignment.substr(0, sign), assignment.substr(sign + 1));
    }
    return input;
}

std::optional<Scenario> read(const Input& input) {
    try {
        return read_scenario_text(input.text, "x.ini", "x", input.overrides);
    } catch (const InputError& error) {
        require_one_line(error.what());
        return std::nullopt;
    }
}

void require_usable(const Scenario& scenario) {
    const std::string text = scenario_text(scenario);
    const Scenario again = read_scenario_text(text, "again.ini", "again");
    require(scenario_text(again) == text, "what scenario_text writes reads back to the same text");
    require(key_differences(scenario, again).empty(), "no key differs");
    require(!scenario.arms.empty() && again.arms == scenario.arms, "there is an arm");
    constexpr int most_poses = 100;  // a problem's tables grow with the poses; longer ones only take time
    if (scenario.poses <= most_poses) simulation_of(scenario);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    return mutate_scenario(data, size, room, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::optional<Scenario> scenario = read(split({reinterpret_cast<const char*>(data), size}));
    if (scenario) require_usable(*scenario);
    return 0;
}
