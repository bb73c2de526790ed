#pragma once
// The program with the worlds of one's own that the tests add, in a process of its own.

#include <credence/own_world.hpp>
#include <credence/program.hpp>

#include "program.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace credence::test {

/// Begins `build/own ARGUMENTS`, words apart by blanks, in the folder, its messages in `err` and its output in `out`
/// there. Returns the process.
inline pid_t begin_own_program(const Workplace& here, const std::string& arguments) {
    const std::string folder = here.path(""), err = here.path("err"), out = here.path("out");
    const pid_t child = fork();
    if (child != 0) return child;
    std::filesystem::current_path(folder);
    if (freopen(err.c_str(), "w", stderr) == nullptr || freopen(out.c_str(), "w", stdout) == nullptr) _exit(9);
    std::vector<std::string> words{"build/own"};
    std::istringstream rest(arguments);
    for (std::string word; rest >> word;) words.push_back(word);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    _exit(program(static_cast<int>(pointers.size()), pointers.data()));
}

/// Its exit code; of a process that a signal ended, 128 and the signal's number.
inline int end_of(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

inline int own_program(const Workplace& here, const std::string& arguments) {
    return end_of(begin_own_program(here, arguments));
}

}  // namespace credence::test
