#include "cli/process/exit_guard.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdlib>

namespace credence::cli {

namespace {

std::atomic<pid_t> guarded = 0;  ///< a process that this one forks is another, and may exit
std::string& message = *new std::string;  // outlives the static objects, which exit() destroys

extern "C" void refuse_exit() {
    if (guarded != getpid()) return;
    // std::cerr may lead elsewhere, and the exit code says the same where this is lost.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message.data(), message.size());
    _exit(1);
}

}  // namespace

ExitGuard::ExitGuard(const std::string& command) {
    [[maybe_unused]] static const bool registered =
        std::atexit(refuse_exit) == 0 && std::at_quick_exit(refuse_exit) == 0;
    message = command + ": cannot finish (exit() was called in the middle of it, by a world or by a library). A "
                        "library may have said why, above; in a world throw an exception instead.\n";
    guarded = getpid();
}

ExitGuard::~ExitGuard() { guarded = 0; }

}  // namespace credence::cli
