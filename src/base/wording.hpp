#pragma once
// How messages call the program, which has a name of its own where it has worlds of its own, and what an edge of
// credence calls by another name: options, and commands.

#include <credence/text.hpp>

#include <string>
#include <vector>

namespace credence {

/// The word by which the program was started, such as build/tracker; `credence` unless program() was told another.
inline std::string& program_word() {
    static std::string word = "credence";
    return word;
}

/// Its last part, by which messages and help call the program.
inline std::string program_name() { return program_word().substr(program_word().rfind('/') + 1); }

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

/// `Did you mean X? `, to begin a remedy with; empty where no known word is near.
inline std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string meant = closest(word, known);
    return meant.empty() ? "" : "Did you mean " + meant + "? ";
}

}  // namespace credence
