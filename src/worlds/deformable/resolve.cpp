// A scenario of the deformable world as a declaration, and back.

#include "worlds/deformable/deformable.hpp"

#include <credence/error.hpp>
#include "worlds/deformable/keys.hpp"

namespace credence {

namespace {

/// What needs no resolved scenario.
Scenario with_settings(const DeformableSettings& scenario) {
    Scenario declared{first_world, scenario.name, scenario.title, scenario.length_unit, scenario.poses, {}, {}, {}, {}};
    for (const DeformableKey& key : scenario_keys()) declared.settings.push_back({key.name, key.get(scenario)});
    return declared;
}

}  // namespace

Scenario scenario_of(const DeformableSettings& scenario) {
    Scenario declared = with_settings(scenario);
    declared.components = state_components(scenario);
    declared.groups = state_blocks(scenario);
    for (const Arm& arm : arms_of(scenario)) declared.arms.push_back(arm_name(arm));
    return declared;
}

DeformableSettings settings_of(const Scenario& declared) {
    if (declared.world != first_world)
        throw invalid_value(world_key, declared.world, "only trials of the deformable world can be replayed",
                            "Give a scenario of that world");
    DeformableSettings scenario;
    for (const Setting& setting : declared.settings) set_key(scenario, setting.key, setting.value);
    validate(scenario);
    return resolved(scenario);
}

std::string scenario_text(const DeformableSettings& scenario) { return scenario_text(with_settings(scenario)); }

}  // namespace credence
