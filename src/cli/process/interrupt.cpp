#include "cli/process/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace credence::cli {

namespace {

constexpr int exit_at_once = 130;

std::atomic<int> signal_that_came = 0;
std::atomic<bool> ends_process = true;  ///< at the second signal
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void note_signal(int signal) {
    if (signal_that_came.exchange(signal) != 0 && ends_process) _exit(exit_at_once);
}

}  // namespace

Interrupt::Interrupt() {
    signal_that_came = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (signal != SIGHUP || !SignalHandler::ignored(SIGHUP))
            handlers_.emplace_back(signal, note_signal, SA_RESTART);
}

void Interrupt::keep_process() { ends_process = false; }

void Interrupt::ask() {
    int none = 0;
    signal_that_came.compare_exchange_strong(none, SIGTERM);
}

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
