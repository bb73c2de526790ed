#pragma once
// What the program is called: a program with worlds of its own has a name of its own, and its messages say that.

#include <string>

namespace credence {

/// The word by which the program was started, such as build/tracker; `credence` unless program() was told another.
inline std::string& program_word() {
    static std::string word = "credence";
    return word;
}

/// Its last part, by which messages and help call the program.
inline std::string program_name() { return program_word().substr(program_word().rfind('/') + 1); }

}  // namespace credence
