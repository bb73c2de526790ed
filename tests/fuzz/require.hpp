#pragma once
// Properties that must hold for every input.

#include <cstdio>
#include <cstdlib>
#include <string>

namespace credence::fuzz {

/// Ends the process with a line that names the violated property.
inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
}

/// A message is for one line of a terminal.
inline void require_one_line(const std::string& message) {
    require(!message.empty(), "a refusal says something");
    for (const char c : message)
        require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "a refusal is one line without control characters");
}

}  // namespace credence::fuzz
