#pragma once
// Module cli: the program credence as a function: with the worlds that were added before, `main` of somebody's own is two
// lines.

namespace credence {

/// Runs the command line and returns the exit code.
int program(int argc, char** argv);

}  // namespace credence
