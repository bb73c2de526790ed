#pragma once
// What a signal does for a while.

#include <csignal>

namespace credence {

/// While an object exists, a signal is handled by `handler`; afterwards as before, unless the program of which this is
/// a part has installed another handler meanwhile.
class SignalHandler {
public:
    SignalHandler(int signal, void (*handler)(int), int flags = 0) : signal_(signal), handler_(handler) {
        struct sigaction action {};
        action.sa_handler = handler;
        action.sa_flags = flags;
        sigaction(signal, &action, &before_);
    }
    ~SignalHandler() {
        struct sigaction now {};
        sigaction(signal_, nullptr, &now);
        if (now.sa_handler == handler_) sigaction(signal_, &before_, nullptr);
    }
    SignalHandler(const SignalHandler&) = delete;
    SignalHandler& operator=(const SignalHandler&) = delete;

    /// Whether the signal is ignored at present.
    static bool ignored(int signal) {
        struct sigaction now {};
        return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
    }

private:
    int signal_;
    void (*handler_)(int);
    struct sigaction before_ {};
};

}  // namespace credence
