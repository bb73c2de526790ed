#include "cli/process/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <utility>

namespace credence::cli {

namespace {

constexpr int exit_at_once = 130, exit_stopped = 3;

std::atomic<int> signal_that_came = 0;
std::atomic<bool> ends_process = true;  ///< at the second signal
std::atomic<bool> in_blocks = false;
std::atomic<unsigned> longest_block = 0;  ///< in seconds
std::string& end_message = *new std::string;  // outlives the static objects
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void note_signal(int signal) {
    if (!ends_process) {  // alarms are another program's
        signal_that_came = signal;
        return;
    }
    if (signal_that_came.exchange(signal) != 0) _exit(exit_at_once);
    if (in_blocks) alarm(5 + 2 * longest_block);
}

extern "C" void end_process(int) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, end_message.data(), end_message.size());
    _exit(exit_stopped);
}

}  // namespace

Interrupt::Interrupt() {
    signal_that_came = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (signal != SIGHUP || !SignalHandler::ignored(SIGHUP))
            handlers_.emplace_back(signal, note_signal, SA_RESTART);
    if (ends_process) handlers_.emplace_back(SIGALRM, end_process);
}

bool Interrupt::came_after_block() {
    using namespace std::chrono;
    thread_local steady_clock::time_point last = steady_clock::now();
    const steady_clock::time_point before = std::exchange(last, steady_clock::now());
    const auto seconds = static_cast<unsigned>(ceil<std::chrono::seconds>(last - before).count());
    if (seconds > longest_block) longest_block = seconds;  // of two threads at once either is nearly right
    return came();
}

void Interrupt::begin_blocks(const std::string& text) {
    end_message = text;
    in_blocks = true;
}

void Interrupt::end_blocks() {
    in_blocks = false;
    if (ends_process) alarm(0);
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
