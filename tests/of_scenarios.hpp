#pragma once
// Studies of the deformable world, made of its own scenarios.

#include "worlds/deformable/deformable.hpp"
#include <credence/study.hpp>

#include <vector>

namespace credence {

inline std::vector<Declaration> declarations_of(const std::vector<Scenario>& scenarios) {
    std::vector<Declaration> declared;
    for (const Scenario& scenario : scenarios) declared.push_back(declaration_of(scenario));
    return declared;
}

inline Study new_study(const std::vector<Scenario>& scenarios, std::uint64_t root_seed, Keep keep = Keep::trials) {
    return new_study(declarations_of(scenarios), root_seed, keep);
}

inline ScenarioResults empty_results(const Scenario& scenario, Keep keep = Keep::trials) {
    return empty_results(declaration_of(scenario), keep);
}

}  // namespace credence
