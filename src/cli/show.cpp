#include "cli/command.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>
#include <credence/detail/worlds.hpp>

#include "base/wording.hpp"

#include <algorithm>

namespace credence::cli {

namespace {

/// One scenario is printed as a file that can be run; of several, each one is.
void show_scenarios(const std::vector<Scenario>& scenarios) {
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
        if (scenarios.size() > 1)
            print((i > 0 ? "\n# " : "# ") + std::to_string(i + 1) + " of " + std::to_string(scenarios.size()) + ": " +
                  scenarios[i].name + "\n");
        print(scenario_text(scenarios[i]));
    }
}

int show(const Parsed& parsed) {
    if (parsed.arguments.size() > 1) throw InputError("show takes one scenario", {}, "Give one file");
    const std::vector<SweepAxis> axes = parsed.sweep();
    if (!parsed.arguments.empty()) {
        check_kind(parsed.arguments.front(), {FileKind::scenario});
        const std::vector<Scenario> scenarios = read_grid(parsed.arguments.front(), parsed.overrides(), axes);
        show_scenarios(scenarios);
        say_notes(scenarios, "show");
        return 0;
    }
    if (!axes.empty()) throw InputError(as_option("sweep") + " needs a scenario", {}, "Give SCENARIO.ini");
    const Scenario scenario = read_scenario_text("", "defaults", "scenario", parsed.overrides());
    const std::vector<DescribedKey> keys = world_of(scenario).keys();
    const DescribedKey world = described_world();
    print("# " + world.help + "\n");
    // The settings have it of all worlds but the first.
    if (scenario.world == first_world) print(world.key + " = " + world.value + "\n");
    for (const Setting& setting : scenario.settings) {
        const auto described = std::ranges::find(keys, setting.key, &DescribedKey::key);
        if (described != keys.end()) print("# " + described->help + "\n");
        print(setting.key + " = " + setting.value + "\n");
    }
    say_notes({scenario}, "show");
    return 0;
}

}  // namespace

DescribedKey described_world() {
    DescribedKey key{world_key, first_world, "", {}};
    for (const World* world : all_worlds()) key.choices.push_back(world->name());
    key.help = "the world: " + joined(key.choices) + "; each has keys of its own, --set " + world_key + "=" +
               key.choices.back() + " shows them";
    return key;
}

const Command& show_command() {
    static const Command command{
        "show",
        "[SCENARIO.ini] [--set section.key=value]... [--sweep section.key=VALUES]...",
        "print a scenario as resolved, every default visible",
        "\nWithout a file: the defaults, with what each key means. With --sweep: every point of the\n"
        "grid.\n",
        {set_option(), sweep_option()},
        show};
    return command;
}

}  // namespace credence::cli
