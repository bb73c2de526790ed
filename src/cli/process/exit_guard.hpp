#pragma once
// The end of the process in the middle of a command.

#include <string>

namespace credence::cli {

/// While an object exists, exit() in this process, such as that of a user's world, ends it with a message and exit code
/// 1: the code given to exit() is 0 perhaps, which would say that the command is done. _exit() is not noticed.
class ExitGuard {
public:
    /// `command`: the message begins with it.
    explicit ExitGuard(const std::string& command);
    ~ExitGuard();
    ExitGuard(const ExitGuard&) = delete;
    ExitGuard& operator=(const ExitGuard&) = delete;
};

}  // namespace credence::cli
