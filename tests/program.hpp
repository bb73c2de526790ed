#pragma once
// Runs the built program as a user would, in a folder of its own.

#include "temporary_folder.hpp"

#include <string>
#include <vector>

namespace credence::test {

struct Outcome {
    int exit_code = -1;
    std::string out, err;
};

/// A fresh temporary folder, removed with everything in it at the end of the test.
class Workplace {
public:
    /// Path of a file in the folder.
    std::string path(const std::string& name) const { return folder_ / name; }
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;
    /// Names of everything in the folder, sorted.
    std::vector<std::string> names() const;
    /// Runs `credence ARGUMENTS` in the folder through the shell.
    Outcome credence(const std::string& arguments) const;
    /// Runs any shell command in the folder.
    Outcome shell(const std::string& command) const;

private:
    TemporaryFolder folder_;
};

/// The program refused it: one line on the error stream, which says `said`, and nothing on the other one.
void check_refused(const Outcome& outcome, const std::string& said, int exit_code = 2);

/// A scenario whose trials take next to no time.
inline const std::string small_world =
    "[scenario]\nname = small\nposes = 3\n[arms]\ncontrollers = fixed, greedy\n[planner]\nspeeds = 1\n";

/// The project's own scenario files.
std::string seed_scenario(const std::string& name);

}  // namespace credence::test
