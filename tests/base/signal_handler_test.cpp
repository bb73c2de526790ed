// What a signal does for a while.

#include "base/signal_handler.hpp"

#include "catch.hpp"

namespace credence::test::signal_handler_test {

namespace {

volatile std::sig_atomic_t handled_by = 0;
void first(int) { handled_by = 1; }
void second(int) { handled_by = 2; }
void third(int) { handled_by = 3; }

int handler_of(int signal) {
    handled_by = 0;
    std::raise(signal);
    return handled_by;
}

}  // namespace

TEST_CASE("signals: a handler gives way to the one before it, and leaves one that was installed meanwhile") {
    const SignalHandler test(SIGUSR1, first);
    {
        const SignalHandler work(SIGUSR1, second);
        CHECK(handler_of(SIGUSR1) == 2);
    }
    CHECK(handler_of(SIGUSR1) == 1);
    {
        const SignalHandler work(SIGUSR1, second);
        std::signal(SIGUSR1, third);
    }
    CHECK(handler_of(SIGUSR1) == 3);
    std::signal(SIGUSR1, first);
}

}  // namespace credence::test::signal_handler_test
