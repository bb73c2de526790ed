#pragma once
// Module base: the progress of long work.

#include <cstdint>

namespace credence {

/// Progress of a run or of a record that is read: a trial under all its arms counts once.
struct Progress {
    std::int64_t done = 0, total = 0;
    double seconds = 0;
};

}  // namespace credence
