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
