#pragma once
// A scenario's place in a sweep as attributes of its group, for readers that do not parse the scenario's text.

#include <credence/detail/sweep.hpp>

#include "files/hdf5/handle.hpp"

namespace credence {

/// Writes the attributes `sweep_of`, `sweep_keys` and `sweep.KEY` for every key, as a number where the value is one,
/// else as text. Writes nothing where the scenario is not a point of a sweep.
void write_sweep(const hdf5::Handle& group, const SweepPoint& point);

/// Throws hdf5::Error unless the group has exactly these attributes.
void check_sweep(const hdf5::Handle& group, const SweepPoint& point);

}  // namespace credence
