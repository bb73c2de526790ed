#include "command.hpp"

#include <credence/error.hpp>
#include <credence/worlds.hpp>

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
        std::cout << scenario_text(read_declaration(parsed.arguments.front(), parsed.overrides()));
        return 0;
    }
    const Declaration scenario = read_declaration_text("", "defaults", "scenario", parsed.overrides());
    const std::vector<DescribedKey> keys = world_of(scenario).keys();
    for (const Setting& setting : scenario.settings)
        for (const DescribedKey& key : keys)
            if (key.key == setting.key) std::cout << "# " << key.help << "\n" << key.key << " = " << setting.value << "\n";
    return 0;
}

}  // namespace credence::cli
