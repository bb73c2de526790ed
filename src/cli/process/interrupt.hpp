#pragma once
// Stopping a run from outside.

#include <string>

namespace credence::cli {

/// While there is one, SIGINT, SIGTERM and SIGHUP ask the run to stop, and a second one of them ends the program at once
/// with 130. A SIGHUP that was ignored, as nohup has it, still is.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    /// Whether one came. From any thread.
    static bool came();
    /// Its name, such as SIGINT.
    static std::string name();
};

}  // namespace credence::cli
