#pragma once
// How messages call what an edge of credence calls by another name: options, and commands.

#include <string>
#include <vector>

namespace credence {

/// The words of an edge. Those of the program are used until another edge, such as Python, sets its own.
struct Wording {
    std::string (*option)(const std::string& name, const std::string& value);
    std::string (*command)(const std::vector<std::string>& words);
    std::string (*resumption)(const std::string& command_line);  ///< of the run of that command line
};
extern const Wording program_wording;

/// That of this process; only an edge sets it, before it calls anything.
Wording& wording();

/// `--trials`, `--keep aggregates`; an empty value for none.
inline std::string as_option(const std::string& name, const std::string& value = {}) {
    return wording().option(name, value);
}

/// A command line, its words without the program's name: `credence run --help`, in backticks.
inline std::string as_command(const std::vector<std::string>& words) { return wording().command(words); }

}  // namespace credence
