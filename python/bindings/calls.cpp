#include "calls.hpp"

#include "cli/process/interrupt.hpp"

#include <credence/error.hpp>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

namespace credence::python {

namespace {

using namespace std::chrono_literals;

std::timed_mutex& turns = *new std::timed_mutex;  // threads may wait for it when static objects are destroyed
thread_local bool has_turn = false;
thread_local bool keeps_turn = false;  ///< between calls, too: that of the main thread when Python ends
std::atomic<bool> ending = false;

/// Whether Python runs its signal handlers in this thread.
bool is_main_thread() { return gettid() == getpid(); }

/// Waits without Python's lock, which the call in progress may need. Whether there is a turn: the main thread returns
/// now and then for signals.
bool wait_for_turn() {
    const nb::gil_scoped_release released;
    if (is_main_thread()) return turns.try_lock_for(100ms);
    turns.lock();
    return true;
}

void before_fork() {
    const nb::gil_scoped_release released;
    if (!has_turn && !keeps_turn) turns.lock();
}

void after_fork() {
    if (!has_turn && !keeps_turn) turns.unlock();
}

/// A thread that comes back into Python after its end would crash: its call is waited for, and no other one begins.
/// What else Python calls at its end, in this thread, may call credence.
void at_exit() {
    ending = true;
    keeps_turn = true;
    const nb::gil_scoped_release released;
    while (!turns.try_lock_for(50ms)) cli::Interrupt::ask();
}

}  // namespace

cli::Values values_of(const cli::Command& command, const nb::dict& options) {
    cli::Values values;
    for (const auto& [key, value] : options) {
        if (value.is_none() || value.is(nb::bool_(false))) continue;
        std::string name = nb::str(key).c_str();
        std::ranges::replace(name, '_', '-');
        const auto takes_several = [&](const cli::Option& one) { return one.repeatable && one.long_name() == name; };
        if (value.is(nb::bool_(true))) values[name] = {""};
        else if (!nb::isinstance<nb::list>(value) || std::ranges::none_of(command.options, takes_several))
            values[name] = {nb::str(value).c_str()};
        else
            for (const auto& one : nb::borrow<nb::list>(value)) values[name].push_back(nb::str(one).c_str());
    }
    return values;
}

Turn::Turn() {
    if (has_turn)
        throw Failure("cannot begin (a signal handler called credence while it was at work in the same thread). Note "
                      "in the handler what is to be done, and do it after the call.");
    if (must_end()) throw Failure("cannot begin (Python is ending). Call it earlier.");
    while (!keeps_turn && !wait_for_turn())
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    has_turn = true;
}

Turn::~Turn() {
    has_turn = false;
    if (!keeps_turn) turns.unlock();
}

EndOfWork::~EndOfWork() {
    if (!must_end()) return;
    turns.unlock();
    for (;;) pause();
}

bool must_end() { return ending && !keeps_turn; }

void bind_turns() {
    const nb::object after = nb::cpp_function(after_fork);
    nb::module_::import_("os").attr("register_at_fork")(
        nb::arg("before") = nb::cpp_function(before_fork), nb::arg("after_in_parent") = after,
        nb::arg("after_in_child") = after);
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(at_exit));
}

}  // namespace credence::python
