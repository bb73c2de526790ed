#include "cli/process/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace credence::cli {

namespace {

constexpr int caught[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int exit_at_once = 130;

std::atomic<int> signal_that_came = 0;
std::atomic<bool> ends_process = true;  ///< at the second signal
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch nothing else");
struct sigaction before[3];

extern "C" void note_signal(int signal) {
    if (signal_that_came.exchange(signal) != 0 && ends_process) _exit(exit_at_once);
}

}  // namespace

Interrupt::Interrupt() {
    signal_that_came = 0;
    for (int i = 0; i < 3; ++i) {
        struct sigaction action {};
        action.sa_handler = note_signal;
        action.sa_flags = SA_RESTART;
        sigaction(caught[i], &action, &before[i]);
        if (caught[i] == SIGHUP && before[i].sa_handler == SIG_IGN) sigaction(SIGHUP, &before[i], nullptr);
    }
}

Interrupt::~Interrupt() {
    for (int i = 0; i < 3; ++i) sigaction(caught[i], &before[i], nullptr);
}

void Interrupt::keep_process() { ends_process = false; }

bool Interrupt::came() { return signal_that_came != 0; }

std::string Interrupt::name() {
    switch (signal_that_came) {
        case SIGINT: return "SIGINT";
        case SIGTERM: return "SIGTERM";
        case SIGHUP: return "SIGHUP";
        default: return "no signal";
    }
}

}  // namespace credence::cli
