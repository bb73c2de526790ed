#pragma once
// Studies of the deformable world, made of its own scenarios.

#include "worlds/deformable/deformable.hpp"
#include <credence/study.hpp>

#include <vector>

namespace credence {

inline std::vector<Scenario> declarations_of(const std::vector<DeformableSettings>& scenarios) {
    std::vector<Scenario> declared;
    for (const DeformableSettings& scenario : scenarios) declared.push_back(scenario_of(scenario));
    return declared;
}

inline Study new_study(const std::vector<DeformableSettings>& scenarios, std::uint64_t root_seed,
                       Keep keep = Keep::trials) {
    return new_study(declarations_of(scenarios), root_seed, keep);
}

inline ScenarioResults empty_results(const DeformableSettings& scenario, Keep keep = Keep::trials) {
    return empty_results(scenario_of(scenario), keep);
}

}  // namespace credence
