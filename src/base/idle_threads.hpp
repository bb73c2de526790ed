#pragma once
// Threads of OpenMP that have nothing to do.

#include <omp.h>

namespace credence {

/// Ends OpenMP's threads, which would wait for the next parallel region by spinning, as libgomp's do for some
/// milliseconds, while the first thread goes on alone. The next region starts them again, in less than a tenth of one.
inline void end_idle_threads() { omp_pause_resource_all(omp_pause_soft); }

}  // namespace credence
