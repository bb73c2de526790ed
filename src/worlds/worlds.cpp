#include <credence/detail/worlds.hpp>

#include "base/wording.hpp"
#include "worlds/deformable/deformable.hpp"
#include <credence/error.hpp>
#include "worlds/explore/explore.hpp"
#include <credence/text.hpp>

#include <algorithm>

namespace credence {

namespace {

std::vector<std::unique_ptr<const World>>& registry() {
    // A run in another thread needs the worlds while the process exits.
    static auto& all = *[] {
        auto* known = new std::vector<std::unique_ptr<const World>>;
        known->push_back(deformable_world());
        known->push_back(explore_world());
        return known;
    }();
    return all;
}

}  // namespace

std::vector<std::string> baselines_among(const std::vector<std::string>& arms) {
    std::vector<std::string> baselines;
    for (const std::string& arm : arms) {
        const std::string controller = controller_of(arm), rest = arm.substr(controller.size());
        std::vector<std::string> simpler;
        if (controller == "greedy" || controller == "horizon")
            simpler = {"fixed", "waypoints", "follow", "nearest", "random"};
        else if (controller != "fixed")
            simpler = {"fixed"};
        if (controller == "horizon" || controller == "informed") simpler.insert(simpler.begin(), "greedy");
        const auto runs = [&](const std::string& other) {
            return std::find(arms.begin(), arms.end(), other + rest) != arms.end();
        };
        const auto found = std::find_if(simpler.begin(), simpler.end(), runs);
        baselines.push_back(found == simpler.end() ? "" : *found + rest);
    }
    return baselines;
}

void add_world(std::unique_ptr<const World> world) { registry().push_back(std::move(world)); }

std::vector<const World*> all_worlds() {
    std::vector<const World*> all;
    for (const auto& world : registry()) all.push_back(world.get());
    return all;
}

const World* find_world(const std::string& name) {
    for (const auto& world : registry())
        if (world->name() == name) return world.get();
    return nullptr;
}

const World& world_of(const Scenario& scenario) {
    std::vector<std::string> names;
    for (const World* world : all_worlds()) names.push_back(world->name());
    if (std::ranges::count(names, scenario.world) > 1)
        throw invalid_value(world_key, scenario.world, "this program has two worlds of that name",
                            "Give the one that was added another name");
    if (const World* world = find_world(scenario.world)) return *world;
    throw invalid_value(
        world_key, printable(scenario.world), "this program has no such world",
        did_you_mean(scenario.world, names) + "Use the program that has it, or give one of " + joined(names));
}

std::unique_ptr<const Simulation> simulation_of(const Scenario& scenario) {
    return world_of(scenario).simulation(scenario);
}

Trajectory replay_trial(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed, std::int64_t trial) {
    return simulation_of(scenario)->replay(scenario, arm, root_seed, trial);
}

}  // namespace credence
