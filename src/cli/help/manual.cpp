// The manual page credence(1), generated from the program's own descriptions of its commands.

#include "cli/command.hpp"
#include "cli/help/roff.hpp"

#include "build_info.hpp"  // made by CMake

#include "base/program_name.hpp"
#include <credence/error.hpp>
#include "worlds/simulate.hpp"
#include <credence/detail/worlds.hpp>

#include <algorithm>
#include <cctype>
#include <iostream>

namespace credence::cli {

const Command& manual_command() {
    static const Command command{"manual", "", "print the manual page",
                                 "\nTo read it: " + program_name() +
                                     " manual | man -l -. `cmake --install` puts it where man finds\n"
                                 "it.\n",
                                 {}};
    return command;
}

namespace {

struct Example {
    std::string line, what;
};

const std::vector<Example>& examples() {
    static const std::vector<Example> all{
        {"run circle.ini -o study.h5 --trials 1e5 --set noise.heading=0.01",
         "Runs 100,000 trials of a scenario under all its arms, one key changed."},
        {"watch study.h5", "In another terminal: how far it is, and what it says so far."},
        {"report study.h5 --margin 5% --require consistent",
         "Says what the file proves; the exit code is 1 unless every arm is consistent."},
        {"run circle.ini -o study.h5 --trials 1e6 --resume",
         "Goes on after a crash, or grows the study: the same results as if run at once."},
        {"run circle.ini -o study.h5 --overwrite --until trace_P=0.5%",
         "Runs until every mean of trace(P) is known to half a percent."},
        {"compare study.h5 --arms greedy,fixed", "What planning gains, trial by trial."},
        {"run circle.ini -o part2.h5 --shard 2/8", "One of eight parts, on any machine."},
        {"merge part0.h5 part1.h5 part2.h5 -o whole.h5", "The parts made whole."},
        {"replay study.h5 --scenario circle --arm greedy.ekf --trial 17 -o trial.h5",
         "One trial again, with everything that happened in it."},
        {"judge record.h5", "The verdict on a filter of your own."}};
    return all;
}

std::string tag_of(const Option& option) {
    const std::string value = option.value.empty() ? "" : " " + roff::italic(option.value);
    const std::string letter = option.short_name().empty() ? "" : roff::bold("-" + option.short_name()) + value + ", ";
    return letter + roff::bold("--" + option.long_name()) + value;
}

std::string text_of(const Command& command) {
    std::string text = roff::subsection(program_name() + " " + command.name + " " + command.arguments) +
                       roff::filled(command.summary + ".");
    for (const Option& option : command.options) text += roff::tagged(tag_of(option), option.help);
    return text + (command.details.empty() ? "" : roff::paragraph + roff::filled(command.details));
}

std::string described_keys() {
    std::string text = roff::filled(
        "A scenario file is an INI text that names only what differs from the defaults; --set overrides it. Keys,\n"
        "with their defaults:");
    const auto described = [](const DescribedKey& key) {
        return roff::tagged(roff::bold(key.key) + " = " + roff::plain(key.value), key.help);
    };
    text += described(described_world());
    for (const World* world : all_worlds()) {
        if (world->name() != first_world)
            text += roff::filled("Keys of the world " + world->name() + " (scenario.world = " + world->name() + "):");
        for (const DescribedKey& key : world->keys()) text += described(key);
    }
    return text;
}

std::string files_text() {
    return roff::tagged(roff::italic("FILE.h5"), "A results file: HDF5, readable as netCDF-4 by any tool.") +
           roff::tagged(roff::italic("FILE.h5.journal"),
                        "Beside it while a run goes on: all that is finished. --resume resumes it.") +
           roff::tagged(roff::italic("FILE.h5.credence-partial"), "The results file while it is being written.");
}

std::string head() {
    const std::string version = std::string("credence ") + build_info::version;
    const std::string name = program_name();
    std::string title = name;
    std::transform(name.begin(), name.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
    std::string text = ".TH " + roff::plain(title) + " 1 \"" + build_info::release_date + "\" \"" + version +
                       "\" \"User Commands\"\n" + roff::section("NAME") +
                       roff::plain(name) +
                       " \\- consistency of EKF-SLAM filters, and what planning gains, by Monte Carlo\n" +
                       roff::section("SYNOPSIS");
    for (const Command* command : all_commands())
        text += (command == all_commands().front() ? "" : ".br\n") + roff::bold(program_name() + " " + command->name) +
                (command->arguments.empty() ? "" : " " + roff::italic(command->arguments)) + "\n";
    return text + roff::section("DESCRIPTION") +
           roff::filled(
               "Can a filter's covariance be believed, and does planning a path pay? credence runs thousands\n"
               "of seeded trials of EKF-SLAM in a deforming world, on a planned and on a fixed path, and says\n"
               "with stated confidence whether the filter is consistent, optimistic or pessimistic, and what\n"
               "planning gained. --help works for every command, --version says how the program was\n"
               "built.");
}

std::string page() {
    std::string text = head() + roff::section("COMMANDS");
    for (const Command* command : all_commands()) text += text_of(*command);
    text += roff::section("SCENARIOS") + described_keys() + roff::section("EXIT STATUS");
    for (const ExitCode& exit : exit_codes())
        text += roff::tagged(roff::bold(std::to_string(exit.code)), exit.meaning + ".");
    text += roff::section("ENVIRONMENT") +
            roff::tagged(roff::bold(force_target_variable),
                         "portable, v3 or v4: the instruction set to run, for tests; all give the same bits.") +
            roff::tagged(roff::bold("OMP_NUM_THREADS"), "The threads of a run where --threads does not say.") +
            roff::section("FILES") + files_text() + roff::section("EXAMPLES");
    for (const Example& example : examples())
        text += (&example == &examples().front() ? "" : roff::paragraph) + roff::filled(example.what) +
                roff::example(program_name() + " " + example.line);
    return text + roff::section("SEE ALSO") +
           roff::bold("h5dump") + "(1), " + roff::bold("ncdump") +
           "(1), and what is installed in share/doc/credence: the model, the statistics, the results file.\n";
}

}  // namespace

int manual(const Parsed& parsed) {
    if (!parsed.arguments.empty()) throw InputError("manual takes no argument. Leave it out.");
    std::cout << page();
    return 0;
}

}  // namespace credence::cli
