#pragma once
// How Python calls the library: one call at a time, without Python's lock, and with its errors as Python's.

#include <credence/study.hpp>

#include <nanobind/nanobind.h>

#include <functional>
#include <mutex>
#include <optional>

namespace credence::python {

namespace nb = nanobind;

/// What Python's `progress(done, total)` is called with; None: nothing is called.
using Listener = std::optional<nb::callable>;

/// The result of `work`, without Python's lock. One call at a time: HDF5 allows one thread, and signals, streams and
/// progress belong to the process.
template <class Work>
auto alone(const Work& work) {
    static std::mutex& mutex = *new std::mutex;
    const nb::gil_scoped_release released;
    const std::lock_guard locked(mutex);
    return work();
}

/// Calls the listener, on whatever thread.
inline void tell(const Listener& listener, const Progress& progress) {
    if (listener) (*listener)(progress.done, progress.total);
}

}  // namespace credence::python
