// A scenario of the deformable world as a declaration, and back.

#include "worlds/deformable/deformable.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/keys.hpp"

namespace credence {

namespace {

/// What needs no resolved scenario.
Declaration with_settings(const Scenario& scenario) {
    Declaration declared{first_world, scenario.name, scenario.title, scenario.length_unit, scenario.poses, {}, {}, {}, {}};
    for (const ScenarioKey& key : scenario_keys()) declared.settings.push_back({key.name, key.get(scenario)});
    return declared;
}

}  // namespace

Declaration declaration_of(const Scenario& scenario) {
    Declaration declared = with_settings(scenario);
    declared.components = state_components(scenario);
    declared.blocks = state_blocks(scenario);
    for (const Arm& arm : arms_of(scenario)) declared.arms.push_back(arm_name(arm));
    return declared;
}

Scenario scenario_of(const Declaration& declared) {
    if (declared.world != first_world)
        throw invalid_value(world_key, declared.world, "only trials of the deformable world can be replayed",
                            "Give a scenario of that world");
    Scenario scenario;
    for (const Setting& setting : declared.settings) set_key(scenario, setting.key, setting.value);
    validate(scenario);
    return resolved(scenario);
}

std::string scenario_text(const Scenario& scenario) { return scenario_text(with_settings(scenario)); }

}  // namespace credence
