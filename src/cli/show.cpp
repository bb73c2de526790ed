#include "command.hpp"

#include <credence/error.hpp>
#include <credence/scenario_keys.hpp>

#include <iostream>

namespace credence::cli {

const Command& show_command() {
    static const Command command{"show", "[SCENARIO.ini] [--set section.key=value]...",
                                 "print a scenario as resolved, every default visible",
                                 "\nWithout a file: the defaults, with what each key means.\n",
                                 {set_option()}};
    return command;
}

int show(const Parsed& parsed) {
    if (parsed.arguments.size() > 1) throw InputError("show takes one scenario. Give one file.");
    if (!parsed.arguments.empty()) {
        std::cout << scenario_text(read_scenario(parsed.arguments.front(), parsed.overrides()));
        return 0;
    }
    const Scenario scenario = read_scenario_text("", "defaults", "scenario", parsed.overrides());
    for (const ScenarioKey& key : scenario_keys())
        std::cout << "# " << key.help << "\n" << key.name << " = " << key.get(scenario) << "\n";
    return 0;
}

}  // namespace credence::cli
