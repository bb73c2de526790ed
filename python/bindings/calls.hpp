#pragma once
// How Python calls the library: one call at a time, without Python's lock, and with its errors as Python's.

#include "cli/command.hpp"

#include <credence/study.hpp>
#include <credence/text.hpp>

#include <nanobind/nanobind.h>

#include <optional>

namespace credence::python {

namespace nb = nanobind;

/// What Python's `progress(done, total)` is called with; None: nothing is called.
using Listener = std::optional<nb::callable>;

/// A command's options from Python's values by their names: None and False are left out, True is a switch, and a list
/// has the values of an option that may be repeated.
cli::Values values_of(const cli::Command& command, const nb::dict& options);

/// The turn of a call: HDF5 allows one thread, and signals, streams and progress belong to the process. It is taken and
/// given back with Python's lock. Throws Failure in a thread that has it already, as a signal handler may find it, and
/// when Python ends; nb::python_error if a signal handler raises while the main thread waits.
class Turn {
public:
    Turn();
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
};

/// The end of a call's work. When Python ends, a thread stays there for good: Python would end it on its way back,
/// where it may hold a lock, such as that of h5py, for which the end would wait in vain.
class EndOfWork {
public:
    EndOfWork() = default;
    ~EndOfWork();
    EndOfWork(const EndOfWork&) = delete;
    EndOfWork& operator=(const EndOfWork&) = delete;
};

/// The result of `work`, in a turn of its own, without Python's lock.
template <class Work>
auto alone(const Work& work) {
    const Turn turn;
    const nb::gil_scoped_release released;
    const EndOfWork end;
    return work();
}

/// What `report`, `judge` or `compare` says, which was computed when it was asked: its formats are written later.
struct Said {
    cli::Rendering rendering;
    std::string in(const std::string& format) const {
        return alone([&] { return shown(rendering(format)); });
    }
};

/// Whether Python is ending, and this thread's work is to end.
bool must_end();

/// Makes errors those of the package, in Python's words: arguments, and calls.
void bind_errors(nb::module_& module);

/// Lets a fork wait for the turn, so that the child finds nothing half done, and the end of Python for the last one.
void bind_turns();

/// Whether Python is to hear of progress: ten times a second, and of the end. Its lock may take a while to get.
class Due {
public:
    bool operator()(const Progress& now) {
        if (now.seconds < next_ && now.done < now.total) return false;
        next_ = now.seconds + 0.1;
        return true;
    }

private:
    double next_ = 0;
};

}  // namespace credence::python
