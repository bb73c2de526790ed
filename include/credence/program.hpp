#pragma once
// Module cli: the program credence as a function: a program with further worlds adds these and then calls it.

namespace credence {

/// Runs the command line and returns the exit code.
int program(int argc, char** argv);

}  // namespace credence
