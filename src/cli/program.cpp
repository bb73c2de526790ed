// Runs a command line: selects the subcommand and reports errors.

#include "cli/command.hpp"
#include "cli/process/limits.hpp"
#include "cli/process/progress.hpp"

#include "base/wording.hpp"
#include <credence/error.hpp>
#include <credence/program.hpp>
#include "worlds/simulate.hpp"
#include <credence/text.hpp>

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <iostream>

namespace {

using namespace credence;

std::atomic<pid_t> guarded = 0;  ///< a process that this one forks is another, and may exit
std::string& exit_message = *new std::string;  // outlives the static objects, which exit() destroys

extern "C" void refuse_exit() {
    if (guarded != getpid()) return;
    // std::cerr may lead elsewhere, and the exit code says the same where this is lost.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, exit_message.data(), exit_message.size());
    _exit(1);
}

/// While an object exists, exit() in this process, such as that of a user's world, ends it with a message and exit code
/// 1: the code given to exit() is 0 perhaps, which would say that the command is done. _exit() is not noticed.
class ExitGuard {
public:
    /// `command`: the message begins with it.
    explicit ExitGuard(const std::string& command) {
        [[maybe_unused]] static const bool registered =
            std::atexit(refuse_exit) == 0 && std::at_quick_exit(refuse_exit) == 0;
        exit_message = command +
                       ": cannot finish (exit() was called in the middle of it, by a world or by a library). A library "
                       "may have said why, above; in a world throw an exception instead.\n";
        guarded = getpid();
    }
    ~ExitGuard() { guarded = 0; }
    ExitGuard(const ExitGuard&) = delete;
    ExitGuard& operator=(const ExitGuard&) = delete;
};

int help() {
    const std::string name = program_name();
    cli::print(name + ": can a filter's covariance be believed, and does planning a path pay?\n\nusage: " + name +
               " COMMAND ... (`" + name + " COMMAND --help` says more)\n\n");
    for (const cli::Command* command : cli::all_commands())
        std::cout << "  " << command->name << std::string(12 - command->name.size(), ' ') << command->summary << "\n";
    cli::print("\n  --help      this\n  --version   the version and how it was built\n\n" +
               wrapped(std::string("Exit codes: 0 done, 1 failed, 2 bad input, 3 stopped by a signal with everything "
                                   "kept, 130 ended at once by a second signal.")) + "\n");
    return 0;
}

/// The command line as given, quoted where a shell needs it.
std::string command_line(const std::vector<std::string>& words) {
    std::vector<std::string> quoted{shell_word(program_word())};
    for (const std::string& word : words) quoted.push_back(shell_word(word));
    return joined(quoted, " ");
}

/// Whether a command line begins with the name of a command.
bool names_command(const std::vector<std::string>& words) {
    return !words.empty() && !words.front().empty() && words.front().front() != '-';
}

std::vector<std::string> without_first(const std::vector<std::string>& words) {
    return words.empty() ? words : std::vector<std::string>(words.begin() + 1, words.end());
}

/// Prints a message on one line of the standard error, whatever the program's input contains.
int complain(const std::string& message, int exit_code) {
    std::cerr << printable(message, 1000) << "\n";
    return exit_code;
}

int dispatch(const std::string& name, const std::vector<std::string>& arguments, const std::string& line) {
    std::vector<std::string> names{"--help", "--version"};
    for (const cli::Command* command : cli::all_commands()) {
        if (command->name == name) {
            std::optional<cli::Parsed> parsed = cli::parse(*command, arguments);
            if (parsed) parsed->line = line;
            return parsed ? command->work(*parsed) : 0;
        }
        names.push_back(command->name);
    }
    const std::string meant = closest(name, names);
    throw InputError("unknown command " + printable(name), {},
                     meant.empty() ? as_command({"--help"}) + " lists them" : "Did you mean " + meant + "?");
}

int obey_or_complain(const std::vector<std::string>& words) {
    const std::string name = names_command(words) ? words.front() : "";
    const std::string prefix = program_name() + (name.empty() ? "" : " " + name) + ": ";
    try {
        cli::check_process(words);
    } catch (const InputError& error) {
        return complain(prefix + error.what(), 2);
    }
    try {
        const int code = cli::obey(words);
        if (!std::cout.flush()) throw Failure("cannot write to the standard output.");
        return code;
    } catch (const InputError& error) {
        return complain(prefix + error.what(), 2);
    } catch (const std::bad_alloc&) {
        return complain(prefix + (name == "run" ? "out of memory. Ask for fewer trials; --dry-run says what they take."
                                                : "out of memory. The file holds more than fits."),
                        1);
    } catch (const std::exception& error) {
        return complain(prefix + error.what(), 1);
    } catch (...) {
        return complain(prefix + "stopped by what is no std::exception. A world of one's own may have thrown it.", 1);
    }
}

/// Opens each of descriptors 0, 1 and 2 that is closed, so that no file that the program opens gets one of them: a
/// library's messages would be written into that file. Ends the process where this is impossible.
void hold_standard_streams() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) != -1) continue;
        // The descriptor is opened in the mode in which the stream is not used. Reading from or writing to it then
        // fails with EBADF, as on a closed descriptor, and the program reports that its output is lost and exits with
        // 1; output written to /dev/null would be lost silently.
        const int mode = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        // open() returns the lowest free descriptor, which is this one.
        if (open("/dev/null", mode) != descriptor) _exit(1);
    }
}

}  // namespace

namespace credence {

std::vector<const cli::Command*> cli::all_commands() {
    return {&run_command(),    &report_command(), &judge_command(), &compare_command(), &budget_command(),
            &replay_command(), &merge_command(),  &watch_command(), &show_command(),    &completion_command()};
}

/// Handles `--help`, `help`, `help COMMAND` and `--version`, or runs a command.
int cli::obey(const std::vector<std::string>& words) {
    const std::string name = words.empty() ? "--help" : words.front();
    const std::vector<std::string> arguments = without_first(words);
    if (name == "--version") {
        print(version_text());
        return 0;
    }
    if (name != "help" && name != "--help" && name != "-h") {
        const ExitGuard guard(program_name() + " " + name);
        return dispatch(name, arguments, command_line(words));
    }
    return arguments.empty() ? help() : dispatch(arguments.front(), {"--help"}, "");
}

int cli::obey(Parsed parsed) {
    const std::string& name = parsed.command->name;
    const ExitGuard guard(program_name() + " " + name);
    std::vector<std::string> words{name};
    std::ranges::copy(parsed.arguments, std::back_inserter(words));
    for (const auto& [option, values] : parsed.values)
        for (const std::string& value : values) words.push_back("--" + option + (value.empty() ? "" : "=" + value));
    parsed.line = command_line(words);
    return parsed.command->work(parsed);
}

void cli::check_process(const std::vector<std::string>& words) {
    if (names_command(words) && words.front() != "help") best_target(), check_stack();
}

int program(int argc, char** argv) {
    hold_standard_streams();
    wording() = program_wording;
    // When the process ends HDF5 would close its open objects, and might crash over an object that a damaged file kept
    // from being closed. Files that credence writes are closed, and checked, long before.
    H5dont_atexit();
    try {
        if (argc > 0 && *argv[0] != '\0') program_word() = argv[0];
        return obey_or_complain({argv + std::min(argc, 1), argv + argc});
    } catch (const std::bad_alloc&) {  // of the command line or of a message
        std::cerr << program_name() << ": out of memory.\n";
        return 1;
    }
}

}  // namespace credence
